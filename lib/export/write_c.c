/* write_c.c: a model in C99 that is C++ too: no allocation, no state between calls */
#include "export/c_step.h"
#include "export/code.h"
#include "export/shared_text.h"

#include "model/model.h"

#include <string.h>

static void open_function(Text *out, const Code *code, const CodeFunction *f, const char *locals)
{
    (void)code;
    (void)locals;
    text_addf(
        out,
        "\n/* %s, %d x %d%s */\nvoid model_%s(const real *p, real t, const real *y, const real "
        "*s, real *out)\n{\n    int i;\n\n    (void)p, (void)t, (void)y, (void)s;\n"
        "    for (i = 0; i < %d; i++)\n        out[i] = 0;\n",
        f->what, f->rows, f->columns, f->columns > 1 ? ", row by row" : "", f->name,
        f->rows * f->columns);
}

/* --- the runtime --- */

static const char declarations[] =
    "\n#include <math.h>\n\n#ifndef real\n#define real double /* or float: -Dreal=float */\n"
    "#endif\n#define R(v) ((real)(v))\n\n"
    "enum { /* numbers in each array */\n"
    "    MODEL_PARAMETERS = $PARAMETERS, /* that may be changed; then model_prepare() */\n"
    "    MODEL_P = $NP,\n    MODEL_Q = $Q,\n    MODEL_U = $U,\n    MODEL_X = $X,\n"
    "    MODEL_A = $A, /* references of angles over full turns */\n"
    "    MODEL_Y = $Y,\n    MODEL_Z = $Z,\n    MODEL_M = $M,\n    MODEL_S = $S,\n"
    "    MODEL_OUTPUTS = $OUTPUTS,\n    MODEL_CONDITIONS = $CONDITIONS,\n"
    "    MODEL_LARGEST = $LARGEST,\n"
    "    MODEL_WORK = $WORK\n};\n"
    "enum { MODEL_OK, MODEL_SINGULAR, MODEL_NO_SOLUTION, MODEL_IMPULSE, MODEL_LOST }; /* what "
    "functions return */\n\n"
    "#ifdef __cplusplus\nextern \"C\" {\n#endif\n\n"
    "/* the parameters' values, with model_prepare() */\nvoid model_parameters(real *p);\n"
    "/* what follows from parameters alone: after a parameter has changed */\n"
    "void model_prepare(real *p);\n"
    "/* initial conditions, and s there */\nvoid model_start(real *y, real *s);\n"
    "/* s for a state; s as it was is where Newton's method begins. work: MODEL_WORK numbers */\n"
    "int model_solve(const real *p, real t, const real *y, real *s, real *work);\n"
    "/* y' and s */\n"
    "int model_rates(const real *p, real t, const real *y, real *s, real *work, real *rates);\n"
    "/* y onto the constraints: positions, then speeds */\n"
    "int model_project(const real *p, real t, real *y, real *work);\n";

static const char step_declaration[] =
    "/* one step of the classical Runge-Kutta method, with projection; sampled states are set at\n"
    " * their instants, one at its end by the next step */\n"
    "int model_step(const real *p, real t, real step, real *y, real *s, real *work);\n";

static const char modes_declaration[] =
    "/* which ideal switches are closed, as it shows a time h ahead: sets their sides in p. s: "
    "there, "
    "too */\n"
    "int model_exchange(real *p, real t, const real *y, real *s, real h, real *work);\n"
    "/* network states onto what the sides ask of them, as impulses would put them; MODEL_IMPULSE: "
    "which\n * a source would have to give; MODEL_LOST: what was stored would be nowhere. *moved: "
    "how far, of 1\n * and the largest of the kind */\n"
    "int model_meet(const real *p, real t, real *y, real *work, real *moved);\n"
    "/* one step, in pieces where a switch goes over, with the classical Runge-Kutta method */\n"
    "int model_step(real *p, real t, real step, real *y, real *s, real *work);\n";

static const char numbers[] =
    "\nvoid model_prepare(real *p)\n{\n    (void)p;\n$PREPARE}\n"
    "\nvoid model_parameters(real *p)\n{\n$VALUES    model_prepare(p);\n}\n"
    "\nvoid model_start(real *y, real *s)\n{\n    int i;\n\n    (void)y, (void)s;\n"
    "    for (i = 0; i < MODEL_S; i++)\n        s[i] = 0;\n$START}\n$CODE";

static const char partial_pivots[] =
    "\n/* A x = b from the rows [A | b], in which it works: elimination with row pivots */\n"
    "static int model_eliminate(real *a, int n, real *x, real *work)\n{\n"
    "    const int w = n + 1;\n    int i, j, k;\n\n    (void)work;\n"
    "    for (i = 0; i < n; i++) {\n        real most = 0;\n\n"
    "        for (j = 0; j < n; j++)\n            if (R(fabs(a[i * w + j])) > most)\n"
    "                most = R(fabs(a[i * w + j]));\n"
    "        if (!(most > 0))\n            return MODEL_SINGULAR;\n"
    "        for (j = 0; j < w; j++)\n            a[i * w + j] /= most;\n    }\n"
    "    for (j = 0; j < n; j++) { /* unit columns, too: x[j] is how large they were */\n"
    "        x[j] = 0;\n        for (i = 0; i < n; i++)\n"
    "            if (R(fabs(a[i * w + j])) > x[j])\n                x[j] = R(fabs(a[i * w + j]));\n"
    "        if (!(x[j] > 0))\n            return MODEL_SINGULAR;\n"
    "        for (i = 0; i < n; i++)\n            a[i * w + j] /= x[j];\n    }\n"
    "    for (k = 0; k < n; k++) {\n        int pivot = k;\n\n"
    "        for (i = k + 1; i < n; i++)\n"
    "            if (fabs(a[i * w + k]) > fabs(a[pivot * w + k]))\n                pivot = i;\n"
    "        if (!(fabs(a[pivot * w + k]) > (sizeof(real) > 4 ? 1e-14 : 1e-6)))\n"
    "            return MODEL_SINGULAR;\n"
    "        for (j = k; pivot != k && j < w; j++) {\n            const real v = a[k * w + j];\n\n"
    "            a[k * w + j] = a[pivot * w + j];\n            a[pivot * w + j] = v;\n        }\n"
    "        for (i = k + 1; i < n; i++) {\n"
    "            const real v = a[i * w + k] / a[k * w + k];\n\n"
    "            for (j = k + 1; (v > 0 || v < 0) && j < w; j++)\n"
    "                a[i * w + j] -= v * a[k * w + j];\n        }\n    }\n"
    "    for (i = n - 1; i >= 0; i--) {\n        real v = a[i * w + n];\n\n"
    "        for (j = i + 1; j < n; j++)\n            v -= a[i * w + j] * a[j * w + n];\n"
    "        a[i * w + n] = v / a[i * w + i];\n    }\n"
    "    for (i = 0; i < n; i++)\n        x[i] = a[i * w + n] / x[i];\n    return MODEL_OK;\n}\n";

static const char full_pivots[] =
    "\n/* A x = b from the rows [A | b], in which it works: elimination with full pivots. "
    "Constraints\n"
    " * repeat each other: of all solutions the least x. `work`: n (n + 2) numbers */\n"
    "static int model_eliminate(real *a, int n, real *x, real *work)\n{\n"
    "    const int w = n + 1;\n    real *size = work, *order = work + n, *null = work + 2 * n;\n"
    "    int i, j, k, c, rank = n;\n\n"
    "    for (i = 0; i < n; i++) {\n        real most = 0;\n\n"
    "        for (j = 0; j < n; j++)\n            if (R(fabs(a[i * w + j])) > most)\n"
    "                most = R(fabs(a[i * w + j]));\n"
    "        for (j = 0; most > 0 && j < w; j++)\n            a[i * w + j] /= most;\n    }\n"
    "    for (j = 0; j < n; j++) {\n        size[j] = 0;\n        order[j] = R(j);\n"
    "        for (i = 0; i < n; i++)\n            if (R(fabs(a[i * w + j])) > size[j])\n"
    "                size[j] = R(fabs(a[i * w + j]));\n"
    "        if (!(size[j] > 0))\n            size[j] = 1;\n"
    "        for (i = 0; i < n; i++)\n            a[i * w + j] /= size[j];\n    }\n"
    "    for (k = 0; k < rank; k++) {\n        int row = k, column = k;\n\n"
    "        for (i = k; i < n; i++)\n            for (j = k; j < n; j++)\n"
    "                if (fabs(a[i * w + j]) > fabs(a[row * w + column])) {\n"
    "                    row = i;\n                    column = j;\n                }\n"
    "        if (!(fabs(a[row * w + column]) > (sizeof(real) > 4 ? 1e-10 : 1e-5))) {\n"
    "            rank = k;\n            break;\n        }\n"
    "        for (j = 0; j < w; j++) {\n            const real v = a[k * w + j];\n\n"
    "            a[k * w + j] = a[row * w + j];\n            a[row * w + j] = v;\n        }\n"
    "        for (i = 0; i < n; i++) {\n            const real v = a[i * w + k];\n\n"
    "            a[i * w + k] = a[i * w + column];\n            a[i * w + column] = v;\n        }\n"
    "        x[0] = order[k];\n        order[k] = order[column];\n        order[column] = x[0];\n"
    "        for (i = k + 1; i < n; i++) {\n"
    "            const real v = a[i * w + k] / a[k * w + k];\n\n"
    "            for (j = k + 1; (v > 0 || v < 0) && j < w; j++)\n"
    "                a[i * w + j] -= v * a[k * w + j];\n        }\n    }\n"
    "    for (c = rank; c <= n; c++) { /* what A takes to nothing; last, a solution */\n"
    "        real *v = c < n ? null + (c - rank) * n : x;\n\n"
    "        for (i = 0; i < n; i++)\n            v[i] = 0;\n"
    "        for (i = rank - 1; i >= 0; i--) {\n"
    "            real sum = c < n ? -a[i * w + c] : a[i * w + n];\n\n"
    "            for (j = i + 1; j < rank; j++)\n                sum -= a[i * w + j] * v[j];\n"
    "            v[i] = sum / a[i * w + i];\n        }\n"
    "        if (c < n)\n            v[c] = 1;\n"
    "        for (i = 0; i < n; i++) /* in the order of the unknowns: a has room now */\n"
    "            a[n * w - n + (int)order[i]] = v[i] / size[(int)order[i]];\n"
    "        for (i = 0; i < n; i++)\n            v[i] = a[n * w - n + i];\n"
    "        for (k = 0; k < c - rank; k++) {\n            const real *u = null + k * n;\n"
    "            real dot = 0;\n\n"
    "            for (i = 0; i < n; i++)\n                dot += u[i] * v[i];\n"
    "            for (i = 0; i < n; i++)\n                v[i] -= dot * u[i];\n        }\n"
    "        if (c < n) {\n            real sum = 0;\n\n"
    "            for (i = 0; i < n; i++)\n                sum += v[i] * v[i];\n"
    "            for (i = 0; i < n; i++)\n                v[i] /= R(sqrt(sum));\n        }\n    }\n"
    "    return MODEL_OK;\n}\n";

static const char newton[] =
    "\n/* how far rows of [A | b] are from 0, each over its weight */\n"
    "static real model_lack(const real *a, int n, const real *weight)\n{\n    real sum = 0;\n"
    "    int i;\n\n    for (i = 0; i < n; i++)\n"
    "        sum += R(fabs(a[i * (n + 1) + n])) / weight[i];\n    return sum;\n}\n"
    "\n/* Newton's method, its steps shortened where they lead away. Where the full step is next "
    "to "
    "nothing\n * and does not halve the residual, rounding hides what is left: s is the solution. "
    "Where no\n * step does better, as at the kink of a diode's law, undamped from one linear "
    "piece to the next,\n * by shares of steps that leave cycles. */\n"
    "static int model_newton(void (*rows)(const real *, real, const real *, const real *, real "
    "*),\n"
    "                        const real *p, real t, const real *y, real *s, int first, int n,\n"
    "                        real *work)\n{\n"
    "    real *a = work, *x = a + n * (n + 1), *old = x + n, *weight = old + n, *rest = weight + "
    "n;\n"
    "    int i, j, tries, near = 0, pieces = 0;\n\n"
    "    for (tries = 0; tries < 200; tries++) {\n"
    "        real lack, after = 0, step = 1, change = 0, size = 0;\n        int halves;\n\n"
    "        if (pieces > 0 && near == 0)\n"
    "            step = pieces++ < 20 ? R(1) : R(1 - fmod(pieces * 0.381966011, 1));\n"
    "        rows(p, t, y, s, a);\n        for (i = 0; i < n; i++) {\n            weight[i] = 0;\n"
    "            for (j = 0; j < n; j++)\n"
    "                if (R(fabs(a[i * (n + 1) + j])) > weight[i])\n"
    "                    weight[i] = R(fabs(a[i * (n + 1) + j]));\n"
    "            if (!(weight[i] > 0))\n                return MODEL_SINGULAR;\n        }\n"
    "        lack = model_lack(a, n, weight);\n"
    "        if (!(lack - lack <= 0)) { /* no number: s stays one that can be gone on from */\n"
    "            for (i = 0; i < n && tries > 0; i++)\n                s[first + i] = old[i];\n"
    "            return MODEL_NO_SOLUTION;\n        }\n"
    "        if (model_eliminate(a, n, x, rest) != MODEL_OK)\n            return MODEL_SINGULAR;\n"
    "        for (i = 0; i < n; i++)\n            old[i] = s[first + i];\n"
    "        for (halves = 0; halves < 40; halves++, step /= 2) {\n"
    "            for (i = 0; i < n; i++)\n                s[first + i] = old[i] + step * x[i];\n"
    "            if (near > 0 || pieces > 0 || !(lack > 0))\n                break;\n"
    "            rows(p, t, y, s, a);\n"
    "            after = model_lack(a, n, weight);\n            if (after < (1 - step / "
    "8) * lack)\n                break;\n        }\n"
    "        for (i = 0; i < n; i++) {\n"
    "            if (!(R(fabs(x[i])) <= change))\n                change = R(fabs(x[i]));\n"
    "            if (R(fabs(old[i])) > size)\n                size = R(fabs(old[i]));\n        }\n"
    "        if (near == 0 && after > lack / 2 && change <= R(sizeof(real) > 4 ? 1e-12 : 1e-6))\n"
    "            return MODEL_OK;\n"
    "        for (i = 0; i < n && halves == 40; i++)\n            s[first + i] = old[i] + x[i];\n"
    "        pieces += halves == 40;\n"
    "        if (change <= size * R(sizeof(real) > 4 ? 1e-9 : 1e-4) || !(lack > 0))\n"
    "            near++;\n        if (near > 2)\n            return MODEL_OK;\n    }\n"
    "    return MODEL_NO_SOLUTION;\n}\n";

static const char projection[] =
    "\nint model_rates(const real *p, real t, const real *y, real *s, real *work, real *rates)\n{\n"
    "    const int status = model_solve(p, t, y, s, work);\n\n"
    "    model_derivative(p, t, y, s, rates);\n    return status;\n}\n"
    "\nstatic void model_normalise(real *y)\n{\n"
    "    static const int first[] = {0, $FIRSTS}; /* from 1 on */\n    int k, i;\n\n"
    "    for (k = 1; k <= $QUATERNIONS; k++) {\n        real sum = 0;\n\n"
    "        for (i = 0; i < 4; i++)\n            sum += y[first[k] + i] * y[first[k] + i];\n"
    "        for (i = 0; i < 4; i++)\n            y[first[k] + i] /= R(sqrt(sum));\n    }\n}\n"
    "\n/* rows [1 Phi_u^T; Phi_u 0 | 0; b] */\n"
    "static void model_nearest(const real *p, real t, const real *y, real *a, const real *b)\n{\n"
    "    const int n = MODEL_U + MODEL_M, w = n + 1;\n    real *phi_u = a + n * w;\n"
    "    int i, j;\n\n    model_jacobian(p, t, y, y, phi_u);\n"
    "    for (i = 0; i < n * w; i++)\n        a[i] = 0;\n"
    "    for (i = 0; i < MODEL_U; i++)\n        a[i * w + i] = 1;\n"
    "    for (i = 0; i < MODEL_M; i++) {\n        for (j = 0; j < MODEL_U; j++) {\n"
    "            a[j * w + MODEL_U + i] = phi_u[i * MODEL_U + j];\n"
    "            a[(MODEL_U + i) * w + j] = phi_u[i * MODEL_U + j];\n        }\n"
    "        a[(MODEL_U + i) * w + n] = b[i];\n    }\n}\n"
    "\nint model_project(const real *p, real t, real *y, real *work)\n{\n"
    "    const int n = MODEL_U + MODEL_M;\n"
    "    real *b = work, *x = b + n + 1, *a = x + n + 1, *rest = a + n * (n + 1);\n"
    "    int i, j, sweep;\n\n    model_normalise(y);\n"
    "    for (sweep = 0; MODEL_M > 0 && sweep < 20; sweep++) {\n        real most = 0;\n\n"
    "        model_constraints(p, t, y, y, b);\n"
    "        for (i = 0; i < MODEL_M; i++) {\n            b[i] = -b[i];\n"
    "            if (R(fabs(b[i])) > most)\n                most = R(fabs(b[i]));\n        }\n"
    "        if (most <= (sizeof(real) > 4 ? 1e-13 : 1e-6))\n            break;\n"
    "        model_nearest(p, t, y, a, b);\n"
    "        if (model_eliminate(a, n, x, rest) != MODEL_OK)\n            return MODEL_SINGULAR;\n"
    "        model_map(p, t, y, y, a);\n"
    "        for (i = 0; i < MODEL_Q; i++)\n            for (j = 0; j < MODEL_U; j++)\n"
    "                y[i] += a[i * MODEL_U + j] * x[j];\n        model_normalise(y);\n    }\n"
    "    if (MODEL_M > 0) {\n        model_velocity(p, t, y, y, b);\n"
    "        model_jacobian(p, t, y, y, a);\n"
    "        for (i = 0; i < MODEL_M; i++)\n            for (j = 0; j < MODEL_U; j++)\n"
    "                b[i] -= a[i * MODEL_U + j] * y[MODEL_Q + j];\n"
    "        model_nearest(p, t, y, a, b);\n"
    "        if (model_eliminate(a, n, x, rest) != MODEL_OK)\n            return MODEL_SINGULAR;\n"
    "        for (j = 0; j < MODEL_U; j++)\n            y[MODEL_Q + j] += x[j];\n    }\n"
    "    if (MODEL_A > 0) {\n        model_angles(p, t, y, y, b);\n"
    "        for (i = 0; i < MODEL_A; i++)\n            y[MODEL_Q + MODEL_U + MODEL_X + i] = "
    "b[i];\n    }\n"
    "    return $PROJECTED;\n}\n";

static const char check_begin[] =
    "\n#ifdef MODEL_CHECK /* numbers from where this file was made */\n#include <stdio.h>\n\n"
    "static real model_sum(const real *v, int n)\n{\n    real sum = 0;\n    int i;\n\n"
    "    for (i = 0; i < n; i++)\n        sum += R(1 + i % 7) * v[i];\n    return sum;\n}\n"
    "\nstatic double worst;\n"
    "\nstatic int differs(const char *what, int state, real is, double should, double size)\n{\n"
    "    const double off = fabs((double)is - should) / (size > 0 ? size : 1);\n\n"
    "    if (off > worst)\n        worst = off;\n"
    "    if (off <= (sizeof(real) > 4 ? 1e-12 : 1e-2))\n        return 0;\n"
    "    printf(\"%s in state %d: %.17g instead of %.17g\\n\", what, state, (double)is, should);\n"
    "    return 1;\n}\n"
    "\nstatic int model_check(const real *p, int state, double t, const double *states,\n"
    "                       const double *sums, const double *sizes, real *s)\n{\n"
    "    static real y[MODEL_Y + 1], right[MODEL_S + 1], work[MODEL_WORK], out[$ROOM];\n"
    "    static const int parts[] = {MODEL_X, MODEL_Z, MODEL_U, MODEL_M};\n"
    "    int i, part, at = 0, bad = 0, status;\n\n"
    "    for (i = 0; i < MODEL_Y; i++)\n        y[i] = R(states[i]);\n"
    "    for (i = 0; i < MODEL_S; i++)\n        right[i] = R(states[MODEL_Y + i]);\n"
    "    status = model_solve(p, R(t), y, s, work);\n"
    "    if (status != MODEL_OK)\n"
    "        printf(\"state %d: %s\\n\", state, status == MODEL_SINGULAR ? \"singular\" : \"no "
    "solution\");\n"
    "    bad += status != MODEL_OK;\n"
    "    for (part = 0; part < 4; at += parts[part++]) {\n"
    "        for (i = at; i < at + parts[part]; i++)\n"
    "            bad += differs(\"s\", state, s[i], (double)right[i], sizes[part]);\n    }\n"
    "    for (i = 0; i < MODEL_Y; i++) /* functions are looked at away from the constraints */\n"
    "        y[i] *= R(1 + R(i % 5 + 1) / 32);\n";

static void add_rows(const Code *code, Text *out)
{
    text_add(out, "\nint model_solve(const real *p, real t, const real *y, real *s, real *work)\n"
                  "{\n    int i, status = MODEL_OK;\n\n    (void)i, (void)work;\n");
    for (int g = 0; g < code->group_count; g++) {
        const CodeGroup *group = &code->groups[g];
        const char *name = code->functions.at[group->function].name;

        if (code_has_modes(code) && g == code->modes.group)
            text_add(out, "    status = model_mode_solve(p, t, y, s, 0, work, &i);\n"
                          "    if (status != MODEL_OK)\n        return status;\n");
        else if (group->iterates)
            text_addf(out,
                      "    status = model_newton(model_%s, p, t, y, s, %d, %d, work);\n"
                      "    if (status != MODEL_OK)\n        return status;\n",
                      name, group->first, group->count);
        else
            text_addf(out,
                      "    model_%s(p, t, y, s, work);\n"
                      "    status = model_eliminate(work, %d, s + %d, work + %d);\n"
                      "    if (status != MODEL_OK)\n        return status;\n",
                      name, group->count, group->first, group->count * (group->count + 1));
    }
    if (code->is_explicit)
        text_addf(out,
                  "    model_accelerations(p, t, y, s, s + %d);\n"
                  "    for (i = 0; i < MODEL_U + MODEL_M; i++)\n"
                  "        if (!(fabs(s[%d + i]) <= 1e300))\n            return MODEL_SINGULAR;\n",
                  code->layout->nx + code->layout->nz, code->layout->nx + code->layout->nz);
    text_add(out, "    return status;\n}\n");
}

static void add_tangent_declarations(Text *out)
{
    text_add(out, "/* s[MODEL_S]: dt, dy, ds, which it sets, and dp */\n"
                  "int model_tangent(const real *p, real t, const real *y, real *s, real *work);\n"
                  "/* A direction along which what is solved for may move, by equations that "
                  "determine it no\n * further, where that puts ds; 0 where they do */\n"
                  "int model_open(const real *p, real t, const real *y, real *s, real *work);\n"
                  "/* A x = b, from rows [A | b] */\n"
                  "int model_solve_rows(real *a, int n, real *x, real *work);\n");
}

/* the same of rows in the mode of p */
static void add_mode_tangent(const Code *code, Text *out)
{
    static const char *const rows[] = {"a", "d", "c"};
    const int functions[] = {code->groups[code->modes.group].function, code->modes.functions[0],
                             code->modes.functions[1]};
    const int *const by_rest = code->live.tangents[0], *const by_p = code->live.tangents[1];
    const int tangents[][2] = {{by_rest[code->modes.group], by_p[code->modes.group]},
                               {by_rest[2], by_p[2]},
                               {by_rest[3], by_p[3]}};

    text_add(out,
             "\nstatic int model_mode_tangent(const real *p, real t, const real *y, const real "
             "*s, real *ds,\n                              int moves, real *work)\n{\n"
             "    const int n = MODEL_MODES_N;\n    const ModelRoom r = model_room(work);\n"
             "    int i, unused = 0, status;\n\n");
    for (int k = 0; k < COUNT(rows); k++)
        text_addf(out,
                  "    model_%s(p, t, y, s, r.%s);\n    model_%s(p, t, y, s, r.old);\n"
                  "    for (i = 0; i < n; i++)\n        r.%s[i * (n + 1) + n] = r.old[i];\n"
                  "    if (moves)\n        model_%s(p, t, y, s, r.old);\n"
                  "    for (i = 0; moves && i < n; i++)\n        r.%s[i * (n + 1) + n] += "
                  "r.old[i];\n",
                  code->functions.at[functions[k]].name, rows[k],
                  code->functions.at[tangents[k][0]].name, rows[k],
                  code->functions.at[tangents[k][1]].name, rows[k]);
    text_add(out, "    model_reduce(&r, 0, r.old, &unused);\n"
                  "    status = model_eliminate(r.a, n, r.x, r.rest);\n"
                  "    for (i = 0; i < n; i++)\n        ds[MODEL_MODES_FIRST + i] = r.x[i];\n"
                  "    return status;\n}\n");
}

/* ds along a direction in t and y, stored after these: code_live.c */
static void add_tangent(const Code *code, Text *out)
{
    const int first = code->ns + 1 + code->ny, own = 1 + code->ny + code->ns;

    if (code_has_modes(code))
        add_mode_tangent(code, out);
    text_add(out, "\nint model_tangent(const real *p, real t, const real *y, real *s, real *work)\n"
                  "{\n    int i, moves = 0, status = MODEL_OK;\n\n    (void)work;\n");
    text_addf(out,
              "    for (i = 0; i < %d; i++) /* parameters */\n"
              "        moves |= s[%d + i] > 0 || s[%d + i] < 0;\n",
              code->live.seed_count - own, code->ns + own, code->ns + own);
    for (int g = 0; g < code->group_count; g++) {
        const CodeGroup *group = &code->groups[g];
        const int rows = group->count * (group->count + 1);

        if (code_has_modes(code) && g == code->modes.group) {
            text_addf(out,
                      "    status = model_mode_tangent(p, t, y, s, s + %d, moves, work);\n"
                      "    if (status != MODEL_OK)\n        return status;\n",
                      first);
            continue;
        }
        text_addf(out,
                  "    model_%s(p, t, y, s, work);\n    model_%s(p, t, y, s, work + %d);\n"
                  "    for (i = 0; i < %d; i++)\n        work[i * %d + %d] = work[%d + i];\n"
                  "    if (moves)\n        model_%s(p, t, y, s, work + %d);\n"
                  "    for (i = 0; moves && i < %d; i++)\n        work[i * %d + %d] += work[%d + "
                  "i];\n"
                  "    status = model_eliminate(work, %d, s + %d, work + %d);\n"
                  "    if (status != MODEL_OK)\n        return status;\n",
                  code->functions.at[group->function].name,
                  code->functions.at[code->live.tangents[0][g]].name, rows, group->count,
                  group->count + 1, group->count, rows,
                  code->functions.at[code->live.tangents[1][g]].name, rows, group->count,
                  group->count + 1, group->count, rows, group->count, first + group->first, rows);
    }
    if (code->is_explicit)
        text_addf(out,
                  "    model_tangent_accelerations(p, t, y, s, s + %d);\n"
                  "    if (moves)\n        model_tangent_p_accelerations(p, t, y, s, work);\n"
                  "    for (i = 0; moves && i < MODEL_U + MODEL_M; i++)\n"
                  "        s[%d + i] += work[i];\n",
                  first + code->layout->nx + code->layout->nz,
                  first + code->layout->nx + code->layout->nz);
    text_add(out, "    return status;\n}\n"
                  "\nint model_solve_rows(real *a, int n, real *x, real *work)\n{\n"
                  "    return model_eliminate(a, n, x, work);\n}\n");
}

static void add_lines(Text *out, const char *const *lines)
{
    for (; *lines != NULL; lines++)
        text_add(out, *lines);
}

/* a direction in which ds is undetermined, after dt and dy */
static void add_open(const Code *code, Text *out)
{
    const int first = code->ns + 1 + code->ny;

    if (code->group_count > 0)
        add_lines(out, shared_text_open_c);
    text_addf(out,
              "\nint model_open(const real *p, real t, const real *y, real *s, real *work)\n{\n"
              "    int i, status = MODEL_OK;\n\n    (void)p, (void)t, (void)y, (void)work;\n"
              "    for (i = 0; i < MODEL_S; i++)\n        s[%d + i] = 0;\n",
              first);
    for (int g = 0; g < code->group_count; g++) {
        const CodeGroup *group = &code->groups[g];

        if (code_has_modes(code) && g == code->modes.group)
            text_addf(out,
                      "    status = model_open_modes(p, t, y, s, s + %d, work);\n"
                      "    if (status != MODEL_OK)\n        return status;\n",
                      first);
        else
            text_addf(out,
                      "    model_%s(p, t, y, s, work);\n"
                      "    for (i = 0; i < %d; i++)\n        work[i * %d + %d] = 0;\n"
                      "    status = model_open_rows(work, %d, s + %d, work + %d);\n"
                      "    if (status != MODEL_OK)\n        return status;\n",
                      code->functions.at[group->function].name, group->count, group->count + 1,
                      group->count, group->count, first + group->first,
                      group->count * (group->count + 1));
    }
    text_add(out, "    return status;\n}\n");
}

static void add_list(Text *out, const double *values, int count)
{
    for (int i = 0; i < count; i++) {
        text_add(out, i % 4 == 0 ? "\n        " : " ");
        text_number(out, values[i], 17);
        text_char(out, ',');
    }
}

static void add_check(const Code *code, const Language *language, Text *out)
{
    double sizes[CODE_PARTS];

    code_fill(code, language, check_begin, out);
    for (int f = 0; f < code->functions.count; f++) {
        const CodeFunction *function = &code->functions.at[f];

        if (function->rows * function->columns > 0)
            text_addf(out,
                      "    model_%s(p, R(t), y, right, out);\n"
                      "    bad += differs(\"%s\", state, model_sum(out, %d), sums[%d], "
                      "sums[%d]);\n",
                      function->name, function->name, function->rows * function->columns, 2 * f,
                      2 * f + 1);
    }
    text_add(out, "    return bad;\n}\n\nint main(void)\n{\n"
                  "    static real p[MODEL_P + 1], y[MODEL_Y + 1], s[MODEL_S + 1];\n"
                  "    static const double sizes[] = {");
    code_sizes(code, sizes);
    add_list(out, sizes, CODE_PARTS);
    text_add(out, "\n        0};\n    int bad = 0;\n\n    model_parameters(p);\n"
                  "    model_start(y, s);\n");
    if (code_has_modes(code))
        text_add(out, "    bad += model_check_sides(p, y, s);\n");
    for (int k = 0; k < code->states.count; k++) {
        const CodeState *state = &code->states.at[k];

        text_add(out, "    {\n        static const double states[] = {");
        add_list(out, state->y, code->ny);
        add_list(out, state->s, code->ns);
        text_add(out, "\n        0};\n        static const double sums[] = {");
        for (int f = 0; f < code->functions.count; f++) {
            const double both[] = {state->sums[f], state->size[f]};

            add_list(out, both, 2);
        }
        text_addf(out, "\n        0};\n\n        bad += model_check(p, %d, ", k + 1);
        text_number(out, state->t, 17);
        text_add(out, ", states, sums, sizes, s);\n    }\n");
    }
    text_addf(out,
              "    printf(\"%d states: %%s, off by %%.1e at most\\n\",\n"
              "           bad == 0 ? \"all as they were\" : \"NOT as they were\", worst);\n"
              "    return bad > 0;\n}\n#endif\n",
              code->states.count);
}

/* a column's name of a csv file, within a string of C */
static void add_column(const char *name, Text *out)
{
    static const char *const to[] = {"\\\"\\\""};
    const char *quote = strpbrk(name, ",\"") != NULL ? "\\\"" : "";

    text_addf(out, ",%s", quote);
    text_replace(out, name, "\"", to);
    text_add(out, quote);
}

static void add_driver(const Code *code, Text *out)
{
    const VariableIndex *l = code->layout;

    text_add(out, "\n#ifdef MODEL_MAIN /* a.out SECONDS STEP: values at each step, as csv */\n"
                  "#include <stdio.h>\n#include <stdlib.h>\n\nint main(int argc, char **argv)\n{\n"
                  "    static real p[MODEL_P + 1], y[MODEL_Y + 1], s[MODEL_S + 1], "
                  "work[MODEL_WORK];\n    static real out[MODEL_OUTPUTS + 1];\n"
                  "    const double end = argc > 1 ? atof(argv[1]) : 1, step = argc > 2 ? "
                  "atof(argv[2]) : 1e-3;\n"
                  "    const long count = (long)(end / step + 0.5);\n    long k;\n    int i;\n\n"
                  "    model_parameters(p);\n    model_start(y, s);\n    puts(\"t");
    for (int i = 0; i < code->ny; i++)
        text_addf(out, ",%s",
                  i < l->n                           ? system_q(l->system, i)->name
                  : i < l->n + l->nu                 ? system_u(l->system, i - l->n)->name
                  : i < variable_index_references(l) ? system_x(l->system, i - l->n - l->nu)->name
                                                     : "reference");
    for (int i = 0; i < code->outputs.count; i++)
        add_column(code->outputs.at[i], out);
    text_add(out, "\");\n    for (k = 0;; k++) {\n"
                  "        const real t = R((double)k * step);\n\n"
                  "        if (MODEL_OUTPUTS > 0 && model_solve(p, t, y, s, work) != MODEL_OK)\n"
                  "            return 1;\n        model_outputs(p, t, y, s, out);\n"
                  "        printf(\"%.17g\", (double)k * step);\n"
                  "        for (i = 0; i < MODEL_Y; i++)\n"
                  "            printf(\",%.17g\", (double)y[i]);\n"
                  "        for (i = 0; i < MODEL_OUTPUTS; i++)\n"
                  "            printf(\",%.17g\", (double)out[i]);\n        putchar('\\n');\n"
                  "        if (k >= count)\n            return 0;\n"
                  "        if (model_step(p, t, R(step), y, s, work) != MODEL_OK)\n"
                  "            return 1;\n    }\n}\n#endif\n");
}

static void add_tables(const Code *code, Text *out)
{
    const int count = code->lowered.tables.count;

    if (count == 0)
        return;
    for (int i = 0; i < count; i++) {
        const Curve *curve = code->lowered.tables.at[i];

        text_addf(out,
                  "\n/* x, y and y'' at the points of a spline */\n"
                  "static const double model_table_%d[] = {",
                  i + 1);
        add_list(out, curve->data, 3 * curve->count);
        text_add(out, "\n};\n");
    }
    text_add(out, "\nstatic double model_table(int number, double v, int order)\n{\n"
                  "    const double *x = 0, *y, *m;\n    double h, a, b;\n"
                  "    int n = 0, i = 0, last;\n\n");
    for (int i = 0; i < count; i++)
        text_addf(out,
                  "    if (number == %d) {\n        x = model_table_%d;\n        n = %d;\n    "
                  "}\n",
                  i + 1, i + 1, code->lowered.tables.at[i]->count);
    text_add(out,
             "    y = x + n;\n    m = y + n;\n    last = n - 1;\n"
             "    if (v < x[0] || v > x[n - 1])\n"
             "        return order > 0 ? 0 : v < x[0] ? y[0] : y[n - 1];\n"
             "    while (last - i > 1) {\n        const int middle = (i + last) / 2;\n\n"
             "        if (v < x[middle])\n            last = middle;\n        else\n"
             "            i = middle;\n    }\n"
             "    h = x[i + 1] - x[i];\n    a = (x[i + 1] - v) / h;\n    b = (v - x[i]) / h;\n"
             "    if (order == 0)\n        return a * y[i] + b * y[i + 1] +\n"
             "               ((a * a * a - a) * m[i] + (b * b * b - b) * m[i + 1]) * h * h / 6;\n"
             "    if (order == 1)\n        return (y[i + 1] - y[i]) / h +\n"
             "               ((3 * b * b - 1) * m[i + 1] - (3 * a * a - 1) * m[i]) * h / 6;\n"
             "    return order == 2 ? a * m[i] + b * m[i + 1] : order == 3 ? (m[i + 1] - m[i]) / h"
             " : 0;\n}\n");
}

/* of each state of networks: the first that is a current, a voltage ... as it is */
static void add_kinds(const VariableIndex *l, Text *out)
{
    text_add(out, "static const int model_kind[] = {");
    for (int i = 0; i < l->nx; i++) {
        const char *kind = strrchr(system_x(l->system, i)->name, '.');
        const char *other = NULL;
        int k = -1;

        do
            other = strrchr(system_x(l->system, ++k)->name, '.');
        while (k < i && (kind == NULL || other == NULL || strcmp(kind, other) != 0));
        text_addf(out, "%d, ", k);
    }
    text_add(out, "0};\n");
}

/* the code for modes of ideal switches, after that for elimination */
static void add_modes(const Code *code, Text *out)
{
    text_add(out,
             "\n/* edges whose impulse would be a source's */\nstatic const int model_gives[] = {");
    for (int i = 0; i < code->modes.gives.count; i++)
        text_addf(out, "%d, ", code->modes.gives.at[i]);
    text_add(out, "0};\n");
    add_kinds(code->layout, out);
    add_lines(out, shared_text_modes_c);
}

static void add_inverse_declarations(const Code *code, Text *out)
{
    const int drives = code->inverse->motions.count;

    text_addf(
        out,
        "\nenum { MODEL_DRIVES = %d, MODEL_MOTION = %d }; /* drivers; where p has their "
        "motion */\n"
        "#ifdef __cplusplus\nextern \"C\" {\n#endif\n"
        "/* what the drivers take. motion: what each prescribes, then the rates, then the "
        "second rates;\n"
        " * y and s: as they are, which is where the pose is looked for; states of networks "
        "are y's */\n"
        "int model_inverse(real *p, real t, const real *motion, real *y, real *s, real *work, "
        "real *efforts);\n"
        "#ifdef __cplusplus\n}\n#endif\n",
        drives, model_parameter_count(code->view->model));
}

static void add_inverse(const Code *code, Text *out)
{
    text_add(out, "\nint model_inverse(real *p, real t, const real *motion, real *y, real *s, real "
                  "*work, real *efforts)\n{\n");
    if (code->is_direct) {
        text_add(out, "    static const int driven[] = {");
        for (int k = 0; k < code->direct.count; k++)
            text_addf(out, "%s%d", k > 0 ? ", " : "", code->direct.at[k]);
        text_add(out, "};\n");
    }
    text_add(out, "    int i, status;\n\n    for (i = 0; i < 3 * MODEL_DRIVES; i++)\n"
                  "        p[MODEL_MOTION + i] = motion[i];\n");
    text_add(out, code->is_direct
                      ? "    for (i = 0; i < MODEL_DRIVES; i++) { /* the motion is the state */\n"
                        "        y[driven[i]] = motion[i];\n"
                        "        y[MODEL_Q + driven[i]] = motion[MODEL_DRIVES + i];\n    }\n"
                      : "    model_prepare(p);\n    status = model_project(p, t, y, work);\n"
                        "    if (status != MODEL_OK)\n        return status;\n");
    text_add(out, "    status = model_solve(p, t, y, s, work);\n"
                  "    model_efforts(p, t, y, s, efforts);\n    return status;\n}\n");
}

static void write_file(const Code *code, const Language *language, Text *out)
{
    text_add(out, "/*\n");
    code_head(code, language, " * ", out);
    text_add(out, " */\n#ifndef MODEL_H\n#define MODEL_H\n");
    code_fill(code, language, declarations, out);
    text_add(out, code_has_modes(code) ? modes_declaration : step_declaration);
    if (code_has_modes(code))
        code_modes_begin(code, out);
    for (int f = 0; f < code->functions.count; f++)
        text_addf(
            out, "void model_%s(const real *p, real t, const real *y, const real *s, real *out);\n",
            code->functions.at[f].name);
    if (code->live.is_wanted)
        add_tangent_declarations(out);
    text_add(out, "\n#ifdef __cplusplus\n}\n#endif\n");
    if (code->inverse != NULL)
        add_inverse_declarations(code, out);
    text_add(out, "#endif\n\n"
                  "#ifndef MODEL_DECLARED /* define it to have the declarations alone */\n");
    add_tables(code, out);
    code_fill(code, language, numbers, out);
    text_add(out, code->is_redundant ? full_pivots : partial_pivots);
    for (int g = 0, written = 0; g < code->group_count && !code_has_modes(code); g++)
        if (code->groups[g].iterates && !written++)
            text_add(out, newton);
    if (code_has_modes(code))
        add_modes(code, out);
    add_rows(code, out);
    code_fill(code, language, projection, out);
    c_step_add(code, language, out);
    if (code_has_modes(code)) {
        text_add(out, "\n#ifdef MODEL_CHECK\n#include <stdio.h>\n#endif\n");
        c_step_add_modes(code, language, out);
    }
    if (code->inverse != NULL)
        add_inverse(code, out);
    if (code->live.is_wanted) {
        add_tangent(code, out);
        add_open(code, out);
    } else {
        add_check(code, language, out);
        add_driver(code, out);
    }
    text_add(out, "#endif\n");
}

const Language language_c = {
    .notation = NOTATION_C,
    .differentiates = true,
    .array = "%s[%d]",
    .local = "const real %s = %s;",
    .result = "%s = %s;",
    .onward = "",
    .rounded = "R(%s)",
    .power = {"pow(", ", ", ")"},
    .open = open_function,
    .close = "}\n",
    .check = "cc -DMODEL_CHECK FILE.c -lm && ./a.out",
    .between = ", ",
    .file = write_file,
};
