# a file of data stands beside the script that names it; what is wrong with it has its place there
mkdir sub
cat >sub/drive.csv <<'END'
t,volt
0,0
1,2
2,4
END
cat >sub/model.ct <<'END'
vsource E1 a 0 table("drive.csv", t, "volt")
resistor R1 a b 4
capacitor C1 b 0 0.25
show network
simulate 2 every=0.5
print C1.v, E1.v at 1
export c > "model.c"
save "saved.ct"
END
cotree -q sub/model.ct && grep -c 'model_table_1' model.c && cat saved.ct
sed 's/volt"/vol"/' sub/model.ct >sub/wrong.ct
cotree sub/wrong.ct 2>errors; echo "$?"; cat errors
cat >try.c <<'END'
#include "model.c"
#include <stdio.h>
int main(void)
{
    double p[MODEL_P + 1], y[1] = {0}, s[MODEL_S] = {0}, work[MODEL_WORK];

    model_parameters(p);
    model_solve(p, 1.5, y, s, work);
    printf("%.9g\n", s[0]);
    return 0;
}
END
if command -v cc >/dev/null; then cc -o try try.c -lm && ./try; else echo 3; fi
