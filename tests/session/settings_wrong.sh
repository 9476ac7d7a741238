# what a setting can't be is said where it stands, and the setting stays
cotree -q -k -e 'set units deg' -e 'set units m mm' -e 'set units deg mm foo' -e 'set units [mm]' \
    -e 'set digits' -e 'set digits 3 4' -e 'set jobs 0' -e 'set jobs=1.5' -e 'show settings' | grep -v '^[segnf]' | sed 's/share [0-9]* process[es]*/share SOME processes/'
