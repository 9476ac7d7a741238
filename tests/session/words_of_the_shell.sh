# what a person types first: an empty model, lists with blanks, clear, exit
cat >model.ct <<'END'
a = 2; b = 3
print a b, a*b (a - b)
print a -b
print a b at 0
clear
END
cotree model.ct 2>&1
echo 'simulate 1' | cotree 2>&1
printf 'a = 2\nexit\nprint a\n' | cotree 2>&1
