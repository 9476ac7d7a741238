# wrong usage is status 2, and nothing runs
cotree --no-such-option; echo "$?"
cotree -e; echo "$?"
cotree --seed many -e 'print 1'; echo "$?"
cotree --reference tablets; echo "$?"
echo 'print 1' >first.ct
cotree first.ct missing.ct; echo "$?"
cotree --version | sed 's/[0-9.]*$/VERSION/'
cotree --help | head -n 1
