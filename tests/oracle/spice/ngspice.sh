# shellcheck shell=sh
# What the tests against ngspice share: netlists in steps of h, extrapolated, beside our columns.

here=$TOP_SRCDIR/tests/oracle/spice
ngspice=${NGSPICE:-ngspice}

# spice NAME FACTOR: the netlist in steps of FACTOR*h, on the grid of NAME.csv, as NAME.FACTOR.csv
spice() {
    awk -v factor="$2" '
        NR == 1 {
            print
            # steps are held by their limit, and the equations solved to the last digits
            print ".options trtol=1e12 reltol=1e-9 abstol=1e-14 vntol=1e-12 chgtol=1e-25 itl4=100"
            next
        }
        /^\.param h=/ { sub(/h=/, ""); print ".param h={" factor "*" $2 "}"; next }
        /^\.control/ { print; print "set numdgt=15 wr_singlescale"; next }
        { print }' "$1.cir" >"$1.$2.cir"
    rm -f "$1.out"
    # its exit status tells of plots that weren't asked for
    "$ngspice" -n -b "$1.$2.cir" >"$1.$2.log" 2>&1 </dev/null || :
    if [ ! -s "$1.out" ]; then
        echo "ngspice: $(grep -i error "$1.$2.log")"
        return 1
    fi
    "$here/resample" "$1.csv" "$1.out" >"$1.$2.csv"
}

# extrapolate NAME FINE COARSE: both to h = 0, second order
extrapolate() {
    paste -d, "$1.$2.csv" "$1.$3.csv" | awk -F, '
        {
            line = $1
            for (c = 2; c <= NF/2; c++)
                line = line "," (NR == 1 ? $c : sprintf("%.15g", (4*$c - $(NF/2 + c))/3))
            print line
        }'
}

# compared A B TOLERANCE WHAT
compared() {
    columns=1-$(head -n 1 "$1" | awk -F, '{ print NF }')
    said=$("$TOP_SRCDIR/tests/cases/columns_agree" "$1" "$columns" "$3" "$2") || {
        echo "$4: $said"
        return 1
    }
    echo "$4: $said"
}

# agree NAME [TOLERANCE]
agree() {
    [ -f "$1.ct" ] || cp "$here/$1.ct" "$here/$1.cir" .
    tolerance=${2:-$(sed -n 's/^simulate.* rtol=\([^ ]*\).*/\1/p' "$1.ct" | awk '{ print 10*$1 }')}
    if ! "$COTREE" "$1.ct" >"$1.said" 2>&1; then
        tail -n 12 "$1.said"
        return 1
    fi
    spice "$1" 1 && spice "$1" 2 && spice "$1" 4 || return 1
    extrapolate "$1" 1 2 >"$1.extrapolated.csv"
    extrapolate "$1" 2 4 >"$1.rough.csv"
    compared "$1.extrapolated.csv" "$1.rough.csv" "$tolerance" "$1, ngspice itself" &&
        compared "$1.extrapolated.csv" "$1.csv" "$tolerance" "$1"
}
