
/* --- modes of ideal switches ---
 *
 * Which are closed stands in p. In some modes a combination of the rows [A | b] holds nothing that
 * is solved for: it is a condition on states, which is differentiated once (rows [D | d]). Where
 * that holds nothing either, closed switches alone make a circuit, or open ones a cutset: these
 * share alike (rows [C | c]). */

typedef struct ModelRoom { /* pieces of `work`; rows of N + 1 numbers, but combinations */
    real *a, *d, *c;       /* the rows above */
    real *known, *last;    /* of those that hold nothing: D, and what takes their places */
    real *e;               /* in which is eliminated */
    real *first, *second;  /* combinations of rows, of rows of D */
    real *order, *order_2; /* which row stands where */
    real *x, *old, *zero, *at, *rate, *looks, *edges, *rest;
} ModelRoom;

static ModelRoom model_room(real *work)
{
    const int n = MODEL_MODES_N, w = n + 1;
    ModelRoom r;

    r.a = work;
    r.d = r.a + n * w;
    r.c = r.d + n * w;
    r.known = r.c + n * w;
    r.last = r.known + n * w;
    r.e = r.last + n * w;
    r.first = r.e + n * w;
    r.second = r.first + n * n;
    r.order = r.second + n * n;
    r.order_2 = r.order + n;
    r.x = r.order_2 + n;
    r.old = r.x + n;
    r.zero = r.old + n;
    r.at = r.zero + MODEL_S;
    r.rate = r.at + MODEL_Y;
    r.looks = r.rate + MODEL_Y;
    r.edges = r.looks + 4 * MODEL_SWITCHES;
    r.rest = r.edges + 4 * MODEL_EDGES;
    return r;
}

/* Rank of these rows, and each behind it as a combination of them that is nothing: row order[i] and
 * others. */
static int model_nulls(const real *a, int rows, real *e, real *combination, real *order)
{
    const int n = MODEL_MODES_N, w = n + 1;
    int i, j, k;

    for (i = 0; i < rows; i++) {
        real most = 0;

        for (j = 0; j < n; j++)
            if (R(fabs(a[i * w + j])) > most)
                most = R(fabs(a[i * w + j]));
        if (!(most > 0))
            most = 1;
        for (j = 0; j < n; j++)
            e[i * n + j] = a[i * w + j] / most;
        for (j = 0; j < rows; j++)
            combination[i * rows + j] = i == j ? 1 / most : R(0);
        order[i] = R(i);
    }
    for (j = 0; j < n; j++) {
        real most = 0;

        for (i = 0; i < rows; i++)
            if (R(fabs(e[i * n + j])) > most)
                most = R(fabs(e[i * n + j]));
        for (i = 0; most > 0 && i < rows; i++)
            e[i * n + j] /= most;
    }
    for (k = 0; k < rows && k < n; k++) {
        int row = k, column = k;

        for (i = k; i < rows; i++)
            for (j = k; j < n; j++)
                if (fabs(e[i * n + j]) > fabs(e[row * n + column])) {
                    row = i;
                    column = j;
                }
        if (!(fabs(e[row * n + column]) > (sizeof(real) > 4 ? 1e-10 : 1e-5)))
            break;
        for (j = 0; j < n; j++) {
            const real v = e[k * n + j];

            e[k * n + j] = e[row * n + j];
            e[row * n + j] = v;
        }
        for (j = 0; j < rows; j++) {
            const real v = combination[k * rows + j];

            combination[k * rows + j] = combination[row * rows + j];
            combination[row * rows + j] = v;
        }
        for (i = 0; i < rows; i++) {
            const real v = e[i * n + k];

            e[i * n + k] = e[i * n + column];
            e[i * n + column] = v;
        }
        i = (int)order[k];
        order[k] = order[row];
        order[row] = R(i);
        for (i = k + 1; i < rows; i++) {
            const real v = e[i * n + k] / e[k * n + k];

            for (j = k; (v > 0 || v < 0) && j < n; j++)
                e[i * n + j] -= v * e[k * n + j];
            for (j = 0; (v > 0 || v < 0) && j < rows; j++)
                combination[i * rows + j] -= v * combination[k * rows + j];
        }
    }
    return k;
}

/* Rows [A | b] become those that tell s. A step h: states go on by h times their rates; HUGE_VAL:
 * the step is no longer than its impulses. weight: 0 for rows that are others now. *lacks: what
 * closed switches share, or open ones, can't be nothing as it has to. */
static void model_reduce(const ModelRoom *r, real h, real *weight, int *lacks)
{
    const int n = MODEL_MODES_N, w = n + 1;
    const real nothing = R(sizeof(real) > 4 ? 1e-10 : 1e-5);
    const int rank = model_nulls(r->a, n, r->e, r->first, r->order), rows = n - rank;
    const int is_jump = !(h <= 1e300);
    int i, j, k, m, rank_2;

    for (k = 0; k < rows; k++)
        for (j = 0; j <= n; j++) {
            real sum = 0, size = 0;

            for (i = 0; i < n; i++) {
                const real term = r->first[(rank + k) * n + i] * r->d[i * w + j];

                sum += term;
                size += R(fabs(term));
            }
            r->known[k * w + j] = R(fabs(sum)) > nothing * size ? sum : R(0);
        }
    rank_2 = model_nulls(r->known, rows, r->e, r->second, r->order_2);
    for (k = 0; k < rows; k++) {
        real *out = r->last + k * w;
        real lack = 0, loss = 0;

        for (j = 0; j <= n; j++)
            out[j] = k < rank_2 ? r->known[(int)r->order_2[k] * w + j] : R(0);
        for (i = 0; i < n; i++) {
            real part = 0;

            for (m = 0; k >= rank_2 && m < rows; m++)
                part += r->second[k * rows + m] * r->first[(rank + m) * n + i];
            if (k < rank_2)
                part = r->first[(rank + (int)r->order_2[k]) * n + i];
            lack += part * r->a[i * w + n];
            loss += R(fabs(part * r->a[i * w + n]));
            for (j = 0; k >= rank_2 && j <= n; j++)
                out[j] += part * r->c[i * w + j];
        }
        if (k < rank_2 && h > 0)
            out[n] = is_jump ? lack : lack / h;
        else if (k >= rank_2 && is_jump)
            out[n] = 0;
        else if (k >= rank_2 && h > 0 && R(fabs(lack)) > R(sizeof(real) > 4 ? 1e-9 : 1e-4) * loss) {
            out[n] -= lack / R(MODEL_LEAK);
            *lacks = 1;
        }
    }
    for (k = 0; k < rank && h > 0; k++)
        for (i = (int)r->order[k], j = 0; j <= n; j++)
            if (j == n && is_jump)
                r->a[i * w + j] = 0;
            else if (j < n && !is_jump)
                r->a[i * w + j] += h * r->d[i * w + j];
    for (k = 0; k < rows; k++) {
        i = (int)r->order[rank + (int)r->order_2[k]];
        weight[i] = 0;
        for (j = 0; j <= n; j++)
            r->a[i * w + j] = r->last[k * w + j];
    }
}

/* how far rows are from 0, as large as they are */
static real model_mode_lack(const real *a, const real *weight)
{
    real sum = 0;
    int i;

    for (i = 0; i < MODEL_MODES_N; i++)
        if (weight[i] > 0)
            sum += R(fabs(a[i * (MODEL_MODES_N + 1) + MODEL_MODES_N])) / weight[i];
    return sum;
}

static void model_mode_at(const real *p, real t, const real *y, const real *s, real h,
                          const ModelRoom *r)
{
    int i;

    for (i = 0; i < MODEL_Y; i++)
        r->at[i] = y[i];
    if (h > 0) {
        model_derivative(p, t, y, s, r->rate);
        for (i = 0; i < MODEL_Y; i++)
            r->at[i] += h * r->rate[i];
    }
    model_modes(p, t + h, r->at, s, r->a);
}

/* s in the mode of p; behind a step of length h by the implicit Euler rule, from s = 0. Newton's
 * method, its steps shortened where they lead away; where no step does better, as at the kink of a
 * diode's law, undamped from one linear piece to the next, by shares of steps that leave cycles. */
static int model_mode_solve(const real *p, real t, const real *y, real *s, real h, real *work,
                            int *lacks)
{
    const int n = MODEL_MODES_N, w = n + 1, most = MODEL_IS_LINEAR ? 2 : 200;
    const ModelRoom r = model_room(work);
    real *weight = r.zero; /* nothing else uses it here */
    int i, j, tries, near = 0, pieces = 0;

    for (tries = 0; tries < most; tries++) {
        real lack, step = 1, change = 0, size = 0;
        int halves, more = 0, status;

        if (pieces > 0 && near == 0)
            step = pieces++ < 20 ? R(1) : R(1 - fmod(pieces * 0.381966011, 1));
        model_mode_at(p, t, y, s, h, &r);
        model_mode_rates(p, t + h, r.at, s, r.d);
        model_mode_shares(p, t + h, r.at, s, r.c);
        for (i = 0; i < n; i++) {
            weight[i] = 0;
            for (j = 0; j < n; j++)
                if (R(fabs(r.a[i * w + j])) > weight[i])
                    weight[i] = R(fabs(r.a[i * w + j]));
        }
        model_reduce(&r, h, weight, &more);
        lack = model_mode_lack(r.a, weight);
        if (tries == 0)
            *lacks = more;
        status = model_eliminate(r.a, n, r.x, r.rest);
        if (status != MODEL_OK)
            return status;
        for (i = 0; i < n; i++)
            r.old[i] = s[MODEL_MODES_FIRST + i];
        for (halves = 0; halves < 40; halves++, step /= 2) {
            for (i = 0; i < n; i++)
                s[MODEL_MODES_FIRST + i] = r.old[i] + step * r.x[i];
            if (MODEL_IS_LINEAR || near > 0 || pieces > 0 || !(lack > 0))
                break;
            model_mode_at(p, t, y, s, h, &r);
            if (model_mode_lack(r.a, weight) < (1 - step / 8) * lack)
                break;
        }
        for (i = 0; i < n && halves == 40; i++)
            s[MODEL_MODES_FIRST + i] = r.old[i] + r.x[i];
        pieces += halves == 40;
        for (i = 0; i < n; i++) {
            if (!(R(fabs(r.x[i])) <= change))
                change = R(fabs(r.x[i]));
            if (R(fabs(r.old[i])) > size)
                size = R(fabs(r.old[i]));
        }
        if (*lacks) /* by so much that nothing else counts */
            break;
        if (change <= size * R(sizeof(real) > 4 ? 1e-9 : 1e-4) || !(lack > 0))
            near++;
        if (near > 2)
            break;
    }
    for (i = 0; i < n; i++)
        if (!(fabs(s[MODEL_MODES_FIRST + i]) <= 1e300))
            return MODEL_SINGULAR;
    return tries < most || MODEL_IS_LINEAR ? MODEL_OK : MODEL_NO_SOLUTION;
}

/* By what impulses would move states onto what the mode asks of them: r->zero. */
static int model_jump(const real *p, real t, const real *y, const ModelRoom *r)
{
    int i, unused = 0, status;

    for (i = 0; i < MODEL_S; i++)
        r->zero[i] = 0;
    model_modes(p, t, y, r->zero, r->a);
    model_mode_rates(p, t, y, r->zero, r->d);
    model_mode_shares(p, t, y, r->zero, r->c);
    model_edges(p, t, y, r->zero, r->edges);
    model_reduce(r, R(HUGE_VAL), r->old, &unused);
    status = model_eliminate(r->a, MODEL_MODES_N, r->x, r->rest);
    for (i = 0; status == MODEL_OK && i < MODEL_MODES_N; i++)
        r->zero[MODEL_MODES_FIRST + i] = r->x[i];
    return status;
}

/* r->zero: where the jump leads, against y, from states that are moved by their sizes: one of them,
 * or all (-1). */
static int model_jump_from(const real *p, real t, const real *y, const real *size, int only,
                           const ModelRoom *r)
{
    real move[MODEL_X + 1];
    int i, status;

    for (i = 0; i < MODEL_Y; i++)
        r->at[i] = y[i];
    for (i = 0; i < MODEL_X; i++) {
        const real part = R(0.6180339887498949) * R(i + 1); /* no two moved alike */

        move[i] = only < 0    ? size[i] * (part - R(floor(part)) + R(0.5))
                  : only == i ? size[i]
                              : R(0);
        r->at[MODEL_Q + MODEL_U + i] += move[i];
    }
    status = model_jump(p, t, r->at, r);
    for (i = 0; i < MODEL_X; i++)
        r->zero[i] += move[i];
    return status;
}

/* Whether a state jumps to where it would from anywhere, and moves nothing else by that: what it
 * stored is gone. */
static int model_is_lost(const real *p, real t, const real *y, const real *jump, const real *size,
                         const ModelRoom *r)
{
    const real small = R(sizeof(real) > 4 ? 1e-6 : 1e-3);
    int follows[MODEL_X + 1];
    int i, k;

    if (model_jump_from(p, t, y, size, -1, r) != MODEL_OK)
        return 1;
    for (i = 0; i < MODEL_X; i++)
        follows[i] = !(R(fabs(jump[i])) > small * size[i]) ||
                     R(fabs(r->zero[i] - jump[i])) > small * size[i];
    for (k = 0; k < MODEL_X; k++) {
        if (!follows[k] && model_jump_from(p, t, y, size, k, r) != MODEL_OK)
            return 1;
        for (i = 0; i < MODEL_X && !follows[k]; i++)
            follows[k] = R(fabs(r->zero[i] - jump[i])) > small * size[i];
        if (!follows[k])
            return 1;
    }
    return 0;
}

/* Of each state 1 and the largest of its kind. */
static void model_sizes(const real *y, real *size)
{
    int i, k;

    for (i = 0; i < MODEL_X; i++) {
        size[i] = 1;
        for (k = 0; k < MODEL_X; k++)
            if (model_kind[k] == model_kind[i] &&
                !(R(fabs(y[MODEL_Q + MODEL_U + k])) < size[i] - 1))
                size[i] = 1 + R(fabs(y[MODEL_Q + MODEL_U + k]));
    }
}

/* whether sources give a part of impulses that move states by r->zero */
static int model_is_given(const real *p, real t, const real *y, const ModelRoom *r)
{
    real largest[2] = {0, 0};
    int i, is = 0;

    model_edges(p, t, y, r->zero, r->edges + 2 * MODEL_EDGES);
    for (i = 0; i < 2 * MODEL_EDGES; i++) {
        r->edges[i] = R(fabs(r->edges[2 * MODEL_EDGES + i] - r->edges[i]));
        if (r->edges[i] > largest[i % 2])
            largest[i % 2] = r->edges[i];
    }
    for (i = 0; i < 2 * MODEL_EDGES; i++)
        is |= model_gives[i] && r->edges[i] > R(1e-3) * largest[i % 2];
    return is;
}

/* States onto what the mode asks of them, as impulses would put them: charges of cutsets and fluxes
 * of circuits stay; it tells where they can't. *moved: how far, of 1 and the largest state of its
 * kind; it may be the first of `work`. */
int model_meet(const real *p, real t, real *y, real *work, real *moved)
{
    const ModelRoom r = model_room(work);
    real jump[MODEL_X + MODEL_U + 1], size[MODEL_X + 1], far = 0;
    int i, status = model_jump(p, t, y, &r);

    if (status != MODEL_OK)
        return status;
    model_sizes(y, size);
    for (i = 0; i < MODEL_X + MODEL_U; i++)
        jump[i] = i < MODEL_X ? r.zero[i] : r.zero[i + MODEL_Z];
    for (i = 0; i < MODEL_X; i++)
        if (R(fabs(jump[i])) > far * size[i])
            far = R(fabs(jump[i])) / size[i];
    if (far > R(sizeof(real) > 4 ? 1e-6 : 1e-3))
        status = !MODEL_IS_LINEAR || model_is_given(p, t, y, &r) ? MODEL_IMPULSE
                 : model_is_lost(p, t, y, jump, size, &r)        ? MODEL_LOST
                                                                 : MODEL_OK;
    for (i = 0; i < MODEL_X + MODEL_U; i++)
        y[i < MODEL_X ? MODEL_Q + MODEL_U + i : MODEL_Q + i - MODEL_X] += jump[i];
    *moved = far;
    return status;
}

/* the same of states that an integration has left off the mode: no impulse has */
static int model_drifted(const real *p, real t, real *y, real *work)
{
    const int status = model_meet(p, t, y, work, work);

    return status == MODEL_IMPULSE || status == MODEL_LOST ? MODEL_OK : status;
}

/* --- which mode --- */

/* a diode is the wrong way round, by more than rounding */
static int model_is_wrong(const real *p, const real *look, int k, const real *largest, real noise)
{
    const int is_closed = p[MODEL_CLOSED + k] > R(0.5);
    real least = noise * largest[is_closed ? 0 : 1];

    if (look[2] >= 0) /* a switch, which has its condition */
        return 0;
    if (is_closed && look[3] > 0 && noise * R(1e-3) * largest[1] / look[3] > least)
        least = noise * R(1e-3) * largest[1] / look[3];
    return is_closed ? look[0] < -least : look[1] > least;
}

/* Diodes go over until none is wrong: all that are at a time, and where that leads in circles the
 * first of them alone. */
static int model_settle(real *p, real t, const real *y, real *s, real h, real *work, real noise)
{
    const ModelRoom r = model_room(work);
    const int together = 2 * MODEL_SWITCHES + 8;
    const int most = together + (MODEL_SWITCHES < 12 ? 1 << MODEL_SWITCHES : 4096);
    int turn, k, lacks = 0;

    for (turn = 0; turn < most; turn++) {
        real largest[2] = {0, 0};
        int is_right = 1, status;

        for (k = 0; k < MODEL_MODES_N; k++)
            s[MODEL_MODES_FIRST + k] = 0;
        status = model_mode_solve(p, t, y, s, h, work, &lacks);
        if (status != MODEL_OK)
            return status;
        model_mode_at(p, t, y, s, h, &r);
        model_looks(p, t + h, r.at, s, r.looks);
        model_edges(p, t + h, r.at, s, r.edges);
        for (k = 0; k < 2 * MODEL_EDGES; k++)
            if (R(fabs(r.edges[k])) > largest[k % 2])
                largest[k % 2] = R(fabs(r.edges[k]));
        for (k = 0; k < MODEL_SWITCHES && (is_right || turn < together); k++)
            if (model_is_wrong(p, r.looks + 4 * k, k, largest, noise)) {
                p[MODEL_CLOSED + k] = 1 - p[MODEL_CLOSED + k];
                is_right = 0;
            }
        if (is_right)
            return lacks ? MODEL_NO_SOLUTION : MODEL_OK;
        model_prepare(p);
    }
    return MODEL_NO_SOLUTION;
}

int model_exchange(real *p, real t, const real *y, real *s, real h, real *work)
{
    const ModelRoom r = model_room(work);
    real was[MODEL_SWITCHES];
    int k, round, status = MODEL_OK, changes = 1;

    for (k = 0; k < MODEL_SWITCHES; k++)
        was[k] = p[MODEL_CLOSED + k];
    for (round = 0; status == MODEL_OK && changes && round < 9; round++) {
        real noise = R(sizeof(real) > 4 ? 1e-12 : 1e-5);

        status = model_settle(p, t, y, s, h, work, noise);
        for (k = 0; status != MODEL_OK && k < 4; k++)
            status = model_settle(p, t, y, s, h, work, noise *= 10);
        changes = 0;
        for (k = 0; status == MODEL_OK && k < MODEL_SWITCHES; k++)
            if (r.looks[4 * k + 2] >= 0 &&
                (r.looks[4 * k + 2] > R(0.5)) != (p[MODEL_CLOSED + k] > R(0.5))) {
                p[MODEL_CLOSED + k] = 1 - p[MODEL_CLOSED + k];
                changes = 1;
            }
        if (changes)
            model_prepare(p);
    }
    if (status == MODEL_OK && changes)
        status = MODEL_NO_SOLUTION;
    for (k = 0; status != MODEL_OK && k < MODEL_SWITCHES; k++)
        p[MODEL_CLOSED + k] = was[k];
    if (status != MODEL_OK)
        model_prepare(p);
    return status;
}
