# save replaces what it wrote itself, in one step; anything else only when it is told to
cotree -e 'a = 1' -e 'save "m.ct"' -e 'a = 2' -e 'save "m.ct"'; echo "$?"
cotree m.ct -e 'print a'
echo '# a note' >>m.ct
cotree -e 'a = 3' -e 'save "m.ct"' 2>errors; echo "$?"; cat errors
tail -n 1 m.ct
cotree -e 'a = 4' -e 'save "m.ct" overwrite=on' -e 'save "m.ct" overwrite=off'; echo "$?"
cotree m.ct -e 'print a'
cotree -e 'save "m.ct" overwrite=maybe' 2>errors; echo "$?"; cat errors

# others' files, links to them, empty ones, devices
echo 'letter' >letter.txt
ln -s letter.txt link.ct
for name in letter.txt link.ct; do
    cotree -e 'a = 5' -e "save \"$name\"" 2>/dev/null; echo "$name $?"
done
cat letter.txt
: >empty.ct
cotree -e 'a = 6' -e 'save "empty.ct"'; echo "$?"
cotree -e 'a = 7' -e 'save "/dev/stdout"' | tail -n 1
ln -s m.ct to_ours.ct
cotree -e 'a = 8' -e 'save "to_ours.ct"'; test -L to_ours.ct && cotree m.ct -e 'print a'
tr -d '\n' <m.ct >joined.ct
cotree -e 'save "joined.ct"' 2>/dev/null; echo "$?"

# a folder that can't be written to, a full disk: the old file stays
cp m.ct before.ct
if test -w /dev/full; then
    cotree -e 'a = 9' -e 'save "/dev/full"' 2>errors; echo "$?"; cat errors
else
    printf '%s\n' 1 "-e:2:6: error: can't write '/dev/full': No space left on device" \
        '    save "/dev/full"' '         ^~~~~~~~~~~'
fi
cotree -e 'save "nowhere/m.ct"' 2>/dev/null; echo "$?"
cmp m.ct before.ct
ls | grep 'm\.ct\.' || true
