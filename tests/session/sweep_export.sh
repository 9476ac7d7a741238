# the table of a sweep, for other programs
# tolerance 1e-9
cat >m.ct <<'END'
vsource E1 a 0 10
R = 1 kohm; C = 1 uF
resistor R1 a b R
capacitor C1 b 0 C
END
cat >sweep.ct <<'END'
sweep R=[1 kohm, 2 kohm] C=[1, 0] uF keep=[C1.v, C1.v*2] : op
export csv sweep
export json sweep
export csv sweep > "s.csv"
export csv sweep >> "s.csv"
export mat sweep > "s.mat"
simulate 1 ms every=0.5 ms
export json C1.v
END
cotree -q -k m.ct sweep.ct 2>&1
wc -l <s.csv
tr -c 'a-zA-Z0-9.()*' '\n' <s.mat | grep -E '^(data|names|units)' 
cotree -q m.ct -e 'export csv sweep' 2>&1
cotree -q m.ct -e 'modes' -e 'export json modes' 2>&1
cotree -q -e 'complete export json ' -e 'complete export csv s' -e 'complete sweep L=[1, 2] ' -e 'complete show s'
