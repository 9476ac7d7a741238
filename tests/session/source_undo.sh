# undo takes a whole file back, with the files within it; of a file that fails it is said what stands
cat >inner.ct <<'END'
c = 3
d = 4
END
cat >good.ct <<'END'
b = 2; print "in between"
source "inner.ct"
a = 10
delete d
END
cat >bad.ct <<'END'
a = 5
e = 6

f = 7; plto h8; g = 8
h = 9
END
cat >nothing.ct <<'END'
print 1
plto
END
cat >over.ct <<'END'
undo
k = 1
END
show() { printf 'show params > "p%s.txt"\n' "$1"; }
{
    echo 'a = 1'; show 0
    echo 'source "good.ct"'; show 1
    echo 'undo'; show 2
    echo 'redo'; show 3
    echo 'undo; undo; redo; redo'; show 4
    echo 'source "bad.ct"'; show 5
    echo 'undo'; show 6
    echo 'source "nothing.ct"'; show 7
    echo 'source "over.ct"'; echo 'undo'; show 8
} | cotree -k
for pair in "0 2" "1 3" "1 4" "1 6" "1 7" "0 8"; do
    cmp "p${pair% *}.txt" "p${pair#* }.txt"
done
cat p5.txt
cotree -e "source \"bad.ct\""; echo "status $?"
cotree -k bad.ct || echo "status $?"
