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

# rows go below rows of the same columns alone; what makes a whole file goes below nothing
cat >rows.ct <<'END'
vsource V1 a 0 5
resistor R1 a 0 10
simulate 0.1 every=0.1
export csv V1.v > "x.csv"
export csv V1.v >> "x.csv"
export csv R1.i >> "x.csv"
export mat V1.v >> "x.mat"
plot V1.v >> "x.svg"
draw >> "x.svg"
bode V1.v >> "x.csv"
END
cotree -q -k rows.ct; echo "$?"
cat x.csv
ls x.*
