# -k goes on after errors, and tells them in the exit status; an error outweighs an expectation
printf 'a = 1\nexpect a > 5\nprint a\n' >unmet.ct
printf 'a = 1\nplto a\nexpect a > 5\nprint a\n' >both.ct
cotree -k unmet.ct 2>unmet.txt
echo "$?"
cotree -k both.ct 2>both.txt
echo "$?"
grep -c 'error:' unmet.txt both.txt
