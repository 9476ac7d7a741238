# -k goes on after errors, and tells them in the exit status; an error outweighs an expectation
printf 'a = 1\nexpect a > 5\nprint a\n' >unmet.ct
printf 'a = 1\nplto a\nexpect a > 5\nprint a\n' >both.ct
cotree -k unmet.ct 2>unmet.txt
echo "$?"
cotree -k both.ct 2>both.txt
echo "$?"
grep -c 'error:' unmet.txt both.txt
# a definition whose first line fails: what follows up to its end isn't the model's
cat >head.ct <<'EOF'
subsystem s frames=[A terminals=[e]
R = 5
resistor R1 e 0 R
end
subsystem good terminals=[e]
resistor R1 e 0 5
subsystem inner frames=[2]
resistor R1 e 0 6
end # of inner
resistor R2 e 0 7
end
subsystem u frames=[3]; end
info good
show params
subsystem v frames=[3]
a = 1
EOF
cotree -k head.ct 2>&1
echo "$?"
cotree -q -k -e 'subsystem s frames=3' -e 'a = 1' -e end -e 'print 3' 2>&1
printf 'b = 2\nprint b\n' >after.ct
cotree -q -k head.ct after.ct 2>/dev/null
echo "$?"
