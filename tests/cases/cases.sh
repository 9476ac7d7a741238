# shellcheck shell=sh
# What the canonical cases share: scripts of scripts/, run by the real program as they stand and in
# other trees, forms and methods, against references from outside. tests/data holds every n-th
# row of exact or extended-precision solutions. A script fails by its own `expect` lines, too.

. "$TOP_SRCDIR/tests/claims.sh"
data=$TOP_SRCDIR/tests/data

# runs SCRIPT [SED]: in a folder of its own, edited by SED
runs() {
    rm -rf "$work/run"
    mkdir "$work/run"
    sed -e "${2:-}" "$TOP_SRCDIR/scripts/$1.ct" >"$work/run/script.ct"
    (cd "$work/run" && "$COTREE" script.ct >out 2>&1) && return
    echo "exit status $? of $1 ${2:-}"
    tail -n 12 "$work/run/out"
    return 1
}

# agrees CSV REFERENCE COLUMNS TOLERANCE [FILTER]: what the last run wrote
agrees() {
    ${5:-cat} <"$work/run/$1" >"$work/run/compared.csv"
    said=$("$TOP_SRCDIR/tests/cases/columns_agree" "$2" "$3" "$4" "$work/run/compared.csv") &&
        return
    echo "$1: $said"
    return 1
}

# both SCRIPT SED CSV REFERENCE COLUMNS TOLERANCE
both() {
    runs "$1" "$2" && agrees "$3" "$4" "$5" "$6"
}

# rows_until REFERENCE TIME: its rows up to a time, in $work
rows_until() {
    awk -F, -v end="$2" 'NR == 1 || $1 <= end' "$data/$1" >"$work/until_$2_$1"
}
