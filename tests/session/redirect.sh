# > writes, >> appends, and what can't be written is an error with the file as it was
cat >model.ct <<'END'
a = 1
print a > "out.txt"
print a + 1 >> "out.txt"
print "last" > "twice.txt"
print "last" > "twice.txt"
help quit > "help.txt"
END
cotree model.ct && cat out.txt twice.txt && test -s help.txt
cotree -e 'print 1 > "nowhere/out.txt"'; echo "$?"
cotree -e 'a = 1 ; print a' >/dev/full; echo "$?"
cotree -e 'print 2 > "/dev/full"'; echo "$?"
cotree -e 'clear > "out.txt"' 2>/dev/null; echo "$?"
ls *.txt
