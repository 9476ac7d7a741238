# a script prints the same bytes by file, pipe, -e, source and standard input named -; twice
cat >model.ct <<'END'
scene planar
body m1 mass=2 inertia=0.1; arm r1 m1 [0, 1]   # a comment; with a semicolon
revolute h1 \
    ground r1
init h1 = 60 deg
print h1, h1'
check
END
cotree model.ct >file.txt || echo "file: $?"
cotree model.ct >again.txt || echo "again: $?"
cotree <model.ct >pipe.txt || echo "pipe: $?"
cotree - <model.ct >named.txt || echo "named: $?"
cotree -e 'source "model.ct"' >source.txt || echo "source: $?"
set --
while IFS= read -r line; do
    set -- "$@" -e "$line"
done <model.ct
cotree "$@" >lines.txt || echo "lines: $?"
tr '\n' '\r' <model.ct | sed 's/\r/\r\n/g' >crlf.ct
cotree crlf.ct >crlf.txt || echo "crlf: $?"
tr '\n' '\r' <model.ct >cr.ct
cotree cr.ct >cr.txt || echo "cr: $?"
cotree -e "$(cat crlf.ct)" >crlf_text.txt || echo "crlf as text: $?"
cotree -e "$(cat cr.ct)" >cr_text.txt || echo "cr as text: $?"
{ printf '\357\273\277'; cat model.ct; } >mark.ct
cotree mark.ct >mark.txt || echo "mark: $?"
test -s file.txt || echo "nothing was printed"
for other in again pipe named source lines crlf cr crlf_text cr_text mark; do
    cmp file.txt $other.txt
done
