# a sourced file is found beside the file that names it; an error tells the way to it
mkdir -p parts/more
echo 'source "parts/one.ct"' >main.ct
printf 'a = 1\nsource "more/two.ct"\nprint "never"\n' >parts/one.ct
printf 'print a\nplto a\n' >parts/more/two.ct
cotree main.ct; echo "$?"
echo 'source "self.ct"' >self.ct
cotree self.ct 2>&1 | grep -c 'in source'
cotree self.ct 2>&1 | sed -n 1,4p
cotree -e 'source "missing.ct"'; echo "$?"
echo 'print 1; quit; print 2' >leave.ct
cotree -e 'source "leave.ct"' -e 'print 3'; echo "$?"
