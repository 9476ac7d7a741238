# what needs FLINT is refused by name where FLINT can't be loaded; everything else goes on
library=$(sed -n 's/^#define FLINT_LIBRARY "\(.*\)"$/\1/p' "$TOP_BUILDDIR/config.h")
mkdir broken
: >"broken/$library"
LD_LIBRARY_PATH=broken cotree -k - <<'END' 2>&1 | sed "s/$library/LIBRARY/"
vsource V a 0 10
resistor R a b 5
capacitor C b 0 1 uF
show transfer b.v V
print 2*3
END
