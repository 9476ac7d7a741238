
/* --- what nothing determines ---
 *
 * Where constraints repeat each other, or ideal switches are in series or in parallel, some of what
 * is solved for is shared by a rule that the equations don't tell. It may move along directions in
 * which all equations hold as they are. */

/* The rows [A | b], in which it works: x becomes a direction with A x = b, at random but for what A
 * determines. */
static int model_open_rows(real *a, int n, real *x, real *work)
{
    const int w = n + 1;
    real size[MODEL_S + 1], least[MODEL_S + 1], largest = 0;
    int i, j, status;

    for (j = 0; j < n; j++)
        size[j] = 0;
    for (i = 0; i < n; i++) {
        real most = 0;

        for (j = 0; j < n; j++)
            if (R(fabs(a[i * w + j])) > most)
                most = R(fabs(a[i * w + j]));
        for (j = 0; most > 0 && j < n; j++)
            if (R(fabs(a[i * w + j])) > size[j] * most)
                size[j] = R(fabs(a[i * w + j])) / most;
    }
    for (j = 0; j < n; j++) {
        const real part = R(0.6180339887498949) * R(j + 1); /* no two alike */

        x[j] = (part - R(floor(part)) + R(0.5)) / (size[j] > 0 ? size[j] : R(1));
    }
    for (i = 0; i < n; i++) {
        a[i * w + n] = -a[i * w + n];
        for (j = 0; j < n; j++)
            a[i * w + n] += a[i * w + j] * x[j];
    }
    status = model_eliminate(a, n, least, work);
    for (j = 0; status == MODEL_OK && j < n; j++) {
        x[j] -= least[j];
        if (R(fabs(x[j])) * size[j] > largest)
            largest = R(fabs(x[j])) * size[j];
    }
    for (j = 0; j < n; j++) /* what rounding has left of the others */
        if (!(largest > R(1e-6)) || R(fabs(x[j])) * size[j] < R(1e-7) * largest)
            x[j] = 0;
    return status;
}

#ifdef MODEL_HAS_MODES
static int model_open_modes(const real *p, real t, const real *y, const real *s, real *ds,
                            real *work)
{
    const int n = MODEL_MODES_N;
    const ModelRoom r = model_room(work);
    int i, unused = 0;

    model_modes(p, t, y, s, r.a);
    model_mode_rates(p, t, y, s, r.d);
    model_mode_shares(p, t, y, s, r.c);
    for (i = 0; i < n; i++) {
        const real part = R(0.6180339887498949) * R(i + 1);

        r.a[i * (n + 1) + n] = 0;
        r.d[i * (n + 1) + n] = 0;
        r.c[i * (n + 1) + n] = part - R(floor(part)) + R(0.5); /* what is shared is other */
    }
    model_reduce(&r, 0, r.old, &unused);
    return model_open_rows(r.a, n, ds + MODEL_MODES_FIRST, r.rest);
}
#endif
