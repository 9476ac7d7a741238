# what is no script is refused, without harm
printf 'a = 1\nprint a\0b\nprint a\n' >zero.ct
cotree zero.ct; echo "$?"
mkdir folder
cotree folder; echo "$?"
printf '' >empty.ct
cotree empty.ct; echo "$?"
printf 'print 1' >no_newline.ct
cotree no_newline.ct; echo "$?"
printf '\033[31mplto\033[0m\n' >colors.ct
cotree colors.ct 2>&1 | sed -n 2p
