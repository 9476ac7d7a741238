# --safe: no file is written, and none is read outside the script's folder, whatever the way
mkdir script script/sub outside
echo 'secret = 42' >outside/secret.ct
printf '0,0\n1,1\n' >outside/curve.csv
cp outside/curve.csv script/curve.csv
cp outside/curve.csv script/sub/curve.csv
echo 'near = 1' >script/near.ct
echo 'low = 2; source "low.ct"' >script/sub/inner.ct
echo 'lower = 3' >script/sub/low.ct
ln -s ../outside/secret.ct script/link.ct
ln -s ../outside script/folder
ln -s near.ct script/inside.ct
ln -s ../outside/curve.csv script/link.csv
here=$PWD

# one statement after the other, with what became of it; the script's name and folder vary
try() {
    printf '%s\n' "$1" >script/main.ct
    (cd script && cotree --safe main.ct >out.tmp 2>err.tmp </dev/null)
    first=$?
    cotree -q --safe script/main.ct >/dev/null 2>&1 </dev/null
    second=$?
    cotree --safe "$here/script/main.ct" >/dev/null 2>&1 </dev/null
    third=$?
    echo "$first $second $third  $1" | sed "s|$here|HERE|g"
    sed -n "s|$here|HERE|g; /error:/s/.*error:/   /p" script/err.tmp
    rm -f script/out.tmp script/err.tmp script/main.ct
}
before=$(find . | sort)
echo '--- read'
try 'source "near.ct"'
try 'source "inside.ct"'
try 'source "./sub/../near.ct"'
try 'source "sub/inner.ct"'
try 'source "link.ct"'
try 'source "folder/secret.ct"'
try 'source "../outside/secret.ct"'
try 'source "sub/../../outside/secret.ct"'
try "source \"$here/outside/secret.ct\""
try "source \"$here/script/near.ct\""
try 'source "/dev/null"'
try 'source "/dev/stdin"'
try 'source "/proc/self/environ"'
try 'f(x) = table("curve.csv", x)'
try 'f(x) = table("link.csv", x)'
try 'f(x) = table("../outside/curve.csv", x)'
try "f(x) = table(\"$here/outside/curve.csv\", x)"
try 'print table("folder/curve.csv", 0.5)'
echo '--- write'
model='scene planar; gravity [0, -9.81]; body m mass=1 inertia=1; simulate 1 every=0.5'
try 'save "new.ct"'
try 'save "near.ct" overwrite=on'
try 'record "new.ct"'
try 'print 1 > "new.txt"'
try 'print 1 >> "near.ct"'
try 'show params > "/dev/null"'
try "$model; export csv m.y > \"new.csv\""
try "$model; export csv m.y >> \"new.csv\""
try "$model; modes; export csv modes > \"new.csv\""
try "$model; export c > \"new.c\""
try "$model; plot m.y > \"new.gp\""
try "$model; plot m.y > \"new.svg\""
try "$model; draw > \"new.svg\""
try "$model; draw > \"new.dot\""
model='vsource E a 0 0; resistor R a b 1; capacitor C b 0 1; linearize inputs=[E] outputs=[C.v]'
try "$model; bode > \"new.csv\""
try "$model; bode > \"new.png\""
try 'recover'
test "$before" = "$(find . | sort)" || echo "other files than before"
cat outside/secret.ct script/near.ct

# statements and standard input: the current folder
cd script
cotree --safe -e 'source "near.ct"' -e 'print near'
cotree --safe -e 'source "../outside/secret.ct"' 2>/dev/null; echo "$?"
printf 'source "near.ct"\nprint near\n' | cotree --safe
printf 'source "link.ct"\n' | cotree --safe 2>/dev/null; echo "$?"

# a file of the command line in its own folder, the next statement in the current one
printf 'source "secret.ct"\nprint secret\n' >../outside/main.ct
cotree --safe ../outside/main.ct -e 'source "near.ct"' -e 'print near'
cotree --safe ../outside/main.ct -e 'source "../outside/secret.ct"' 2>/dev/null; echo "$?"
