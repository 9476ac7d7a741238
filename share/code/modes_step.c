
/* whether a diode is the wrong way round, or a switch not as its condition says */
static int model_has_left(const real *p, real t, const real *y, real *s, real *work)
{
    const ModelRoom r = model_room(work);
    int k;

    if (model_solve(p, t, y, s, work) != MODEL_OK)
        return 1;
    model_looks(p, t, y, s, r.looks);
    model_edges(p, t, y, s, r.edges);
    for (k = 0; k < MODEL_SWITCHES; k++) {
        const real *look = r.looks + 4 * k;
        const int is_closed = p[MODEL_CLOSED + k] > R(0.5);
        real largest = 0;
        int i;

        for (i = is_closed ? 0 : 1; i < 2 * MODEL_EDGES; i += 2)
            if (R(fabs(r.edges[i])) > largest)
                largest = R(fabs(r.edges[i]));
        largest *= R(sizeof(real) > 4 ? 1e-11 : 1e-4);
        if (look[2] >= 0 ? (look[2] > R(0.5)) != is_closed
            : is_closed  ? look[0] < -largest
                         : look[1] > largest)
            return 1;
    }
    return 0;
}

/* The mode from here on, as it shows within a step; states onto it. *changes: it is another. */
static int model_go_over(real *p, real t, real step, real *y, real *s, real *work, int *changes)
{
    real was[MODEL_SWITCHES], h, moved;
    int k, status = MODEL_OK;

    *changes = 0;
    for (k = 0; k < MODEL_SWITCHES; k++)
        was[k] = p[MODEL_CLOSED + k];
    for (h = R(1e-4) * step; status == MODEL_OK && !*changes && h < R(0.2) * step; h *= 10) {
        status = model_exchange(p, t, y, s, h, work);
        for (k = 0; k < MODEL_SWITCHES; k++)
            *changes |= fabs(was[k] - p[MODEL_CLOSED + k]) > 0.5;
    }
    return status == MODEL_OK ? model_meet(p, t, y, work, &moved) : status;
}

int model_step(real *p, real t, real step, real *y, real *s, real *work)
{
    real from[MODEL_Y + 1], done = 0;
    int i, events, tries, status = MODEL_OK, changes = 1;

    for (events = 0; status == MODEL_OK && events < 1000; events++) {
        real low = 0, high = step - done;

        for (i = 0; i < MODEL_Y; i++)
            from[i] = y[i];
        status = model_smooth_step(p, t + done, high, y, s, work);
        if (status != MODEL_OK || !changes || !model_has_left(p, t + step, y, s, work))
            return status;
        for (tries = 0; tries < 60 && high - low > R(sizeof(real) > 4 ? 1e-13 : 1e-6) * step;
             tries++) {
            const real middle = (low + high) / 2;

            for (i = 0; i < MODEL_Y; i++)
                y[i] = from[i];
            if (model_smooth_step(p, t + done, middle, y, s, work) != MODEL_OK ||
                model_has_left(p, t + done + middle, y, s, work))
                high = middle;
            else
                low = middle;
        }
        for (i = 0; i < MODEL_Y; i++)
            y[i] = from[i];
        status = model_smooth_step(p, t + done, high, y, s, work);
        done += high;
        if (status == MODEL_OK)
            status = model_go_over(p, t + done, step, y, s, work, &changes);
    }
    return status == MODEL_OK ? MODEL_NO_SOLUTION : status;
}

#ifdef MODEL_CHECK
/* Whether the mode found from all open takes states elsewhere than that of the start; where nothing
 * flows and nothing lies across, more than one will do. */
static int model_check_sides(const real *p, const real *y, real *s)
{
    static real found[MODEL_P + 1], other[MODEL_S + 1], work[MODEL_WORK];
    int i, bad = 0;

    model_parameters(found);
    for (i = 0; i < MODEL_SWITCHES; i++)
        found[MODEL_CLOSED + i] = 0;
    model_prepare(found);
    for (i = 0; i < MODEL_S; i++)
        other[i] = s[i];
    bad += model_exchange(found, 0, y, other, R(1e-9), work) != MODEL_OK;
    bad += model_solve(found, 0, y, other, work) != MODEL_OK;
    bad += model_solve(p, 0, y, s, work) != MODEL_OK;
    for (i = 0; i < MODEL_X; i++)
        bad += fabs(other[i] - s[i]) > (sizeof(real) > 4 ? 1e-6 : 1e-2) * (1 + fabs(s[i]));
    if (bad > 0)
        puts("ideal switches are NOT found as they were");
    return bad;
}
#endif
