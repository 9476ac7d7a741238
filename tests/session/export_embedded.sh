# code of the embedded form: its rows times the accelerations that the code finds otherwise
cat >bar.ct <<'END'
scene planar
gravity [0, -9.81]
body a mass=1 inertia=0.1
body b mass=2 inertia=0.3
body c mass=1.5 inertia=0.2
arm a1 a [-0.2, 0]
arm a2 a [0.2, 0]
arm b1 b [-0.5, 0]
arm b2 b [0.5, 0.1]
arm c1 c [-0.4, 0]
arm c2 c [0.4, 0]
arm g ground [1, 0.2]
revolute h1 ground a1
revolute h2 a2 b1
revolute h3 g c1
revolute h4 c2 b2
tree h1 h2 h3
form embedded independent=[h1]
init h1 = 1, h1' = 2
guess h2 = -0.8, h3 = 1
export c > "bar.c"
export fortran > "bar.f90"
export matlab > "bar.m"
export python > "bar.py"
END
cotree -q bar.ct 2>/dev/null
grep -h 'embedded_.* of the embedded form.*(' bar.c
grep -c 'embedded_forces: the right side' bar.f90 bar.m bar.py
cc -DMODEL_CHECK bar.c -lm -o check && ./check | cut -d, -f1
cat >use.c <<'END'
#include "bar.c"
#include <stdio.h>

int main(void)
{
    real y[MODEL_Y], s[MODEL_S], work[MODEL_WORK], rates[MODEL_Y], p[1], M[MODEL_U], F[1];
    int bad = 0;

    model_start(y, s);
    model_parameters(p);
    for (int i = 0; i < 100; i++) {
        double sum = 0, terms = 0;

        model_step(p, 0, 0.01, y, s, work);
        model_rates(p, 0, y, s, work, rates);
        model_embedded_mass(p, 0, y, s, M);
        model_embedded_forces(p, 0, y, s, F);
        for (int j = 0; j < MODEL_U; j++) {
            sum += M[j] * rates[MODEL_Q + j];
            terms += fabs(M[j] * rates[MODEL_Q + j]);
        }
        bad += !(fabs(sum - F[0]) <= 1e-11 * terms);
    }
    printf("%d of 100 states where G^T M u' is not G^T F\n", bad);
    return 0;
}
END
cc use.c -lm -o use && ./use
echo '--- too many constraints to be written out'
cat >long.ct <<'END'
scene planar
body a mass=1 inertia=0.1
body b mass=2 inertia=0.3
arm a1 a [0.5, 0]
revolute h1 ground a
revolute h2 a1 b
tree absolute
form embedded
export c
END
cotree -q long.ct 2>/dev/null | grep 'embedded'
