# whatever verb the table has, somebody carries it out: none gets past every way to write one
for word in $(cotree --reference words); do
    for operand in '' ' x' ' "f"' ' 1' ' 1 == 1' ' print 1'; do
        printf '%s%s\n' "$word" "$operand"
    done
done | grep -v '^quit\|^exit' >every.ct
grep -c '^revolute' every.ct
cotree --keep-going every.ct 2>&1 | grep 'nobody carries out'
grep -c '^show' every.ct
