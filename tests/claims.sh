# shellcheck shell=sh
# What test scripts share: `. "$TOP_SRCDIR/tests/claims.sh"`, then `claim NAME COMMAND...` for each
# claim, `skip NAME REASON`, and `claims_end` as the last line. $work is a folder of the test's own.

passed=0
failed=0
skipped=0
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

claim() { # name command...
    name_=$1
    shift
    if "$@"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "FAILED $name_"
    fi
}

# Whether this is a build with the sanitizers. There the program runs to show how it uses memory: what
# other programs make of files that it writes in any build alike is told in the others.
is_sanitized() {
    case ${SAN_CFLAGS:-} in *-fsanitize=*) ;; *) false ;; esac
}

skip() { # name reason
    skipped=$((skipped + 1))
    echo "skipped $1: $2"
}

claims_end() {
    echo "$passed passed, $failed failed, $skipped skipped"
    [ "$failed" -eq 0 ]
}
