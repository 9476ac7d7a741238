/* remark.c: the texts of a run's remarks */
#include "simulate/equations/remark.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum {
    POOL = 512,     /* bytes: a chunk of texts */
    SHOWN_TIMES = 6 /* of an event */
};

/* --- store --- */

static const char *keep(Pool *pool, const char *text)
{
    return text != NULL ? pool_text(pool, text, strlen(text)) : NULL;
}

void remarks_add(Remarks *r, Remark remark)
{
    const size_t bytes = (size_t)remark.time_count * sizeof(double);
    double *times = NULL;

    if (r->pool == NULL)
        r->pool = pool_new(POOL);
    remark.what = keep(r->pool, remark.what);
    remark.more = keep(r->pool, remark.more);
    remark.others = keep(r->pool, remark.others);
    if (remark.time_count > 0) {
        times = pool_alloc(r->pool, bytes);
        memcpy(times, remark.times, bytes);
    }
    remark.times = times;
    LIST_PUSH(r->list, remark);
}

void remarks_append(Remarks *r, const Remarks *more)
{
    for (int i = 0; i < more->list.count; i++)
        remarks_add(r, more->list.at[i]);
}

void remarks_free(Remarks *r)
{
    LIST_FREE(r->list);
    pool_free(r->pool);
    r->pool = NULL;
}

/* --- write --- */

static void write_times(const Remark *r, Text *out)
{
    if (r->time_count > 1)
        text_addf(out, "%d times, ", r->time_count);
    text_add(out, "at t = ");
    for (int i = 0; i < r->time_count && i < SHOWN_TIMES; i++)
        text_addf(out, "%s%.9g", i > 0 ? ", " : "", r->times[i]);
    if (r->time_count > SHOWN_TIMES)
        text_addf(out, " ... %.9g", r->times[r->time_count - 1]);
    text_add(out, " s");
}

static void write_start(const Remark *r, Text *out)
{
    switch (r->kind) {
    case REMARK_ASSEMBLED_FAR:
        text_addf(out,
                  "assembled far from where it began: %s went from %.4g to %.4g; a guess chooses "
                  "another assembly",
                  r->what, r->size, r->to);
        break;
    case REMARK_ASSEMBLED_AROUND:
        text_addf(out,
                  "assembled from a start moved by up to %g; guesses make sure that it is the "
                  "assembly meant",
                  r->size);
        break;
    case REMARK_GUESS_MISSED:
        text_addf(out, "no assembly found that meets all guesses: %s went from %.4g to %.4g",
                  r->what, r->size, r->to);
        break;
    case REMARK_START_SINGULAR:
        text_addf(out, "the start is a singular position: %d of %d constraints hold there",
                  r->count, r->of);
        break;
    case REMARK_REDUNDANT:
        text_addf(out, "redundant: %s (%s) %s%s", r->what, r->more,
                  r->others != NULL ? "repeats " : "follows from the rest",
                  r->others != NULL ? r->others : "");
        break;
    case REMARK_UNDETERMINED:
        text_addf(
            out,
            "%d degree%s of freedom without what is redundant; reactions there are not "
            "determined: those reported are the least (minimum norm) of the joints outside the "
            "tree, and depend on it",
            r->count, r->count == 1 ? "" : "s");
        break;
    case REMARK_REST_OPEN:
        text_addf(out, "at rest nothing determines %s: it stays as near to its start as may be",
                  r->what);
        break;
    case REMARK_REST_MANY:
        text_addf(out,
                  "the equilibrium is one of many: %d direction%s in which nothing pushes back",
                  r->count, r->count == 1 ? "" : "s");
        break;
    case REMARK_REST_DRIVEN:
        text_add(out,
                 "drivers move, which an equilibrium leaves out: runs start from here with their "
                 "speeds, and 'equilibrium at=0' keeps them");
        break;
    default:
        break;
    }
}

static void write_steps(const Remark *r, Text *out)
{
    switch (r->kind) {
    case REMARK_STIFF:
        text_addf(out, "stiff from t = %.6g s: went on with %s", r->t, r->what);
        break;
    case REMARK_COUPLED:
        text_addf(
            out,
            "states hardly determine the network's other unknowns at t = %.6g s: went on with %s, "
            "which solves both together",
            r->t, r->what);
        break;
    case REMARK_ROUNDING:
        text_addf(out, "steps limited by rounding at t = %.6g s: went on with %s", r->t, r->what);
        break;
    case REMARK_INDEPENDENT_ANEW:
        text_addf(out, "independent coordinates chosen anew at t = %.6g s", r->t);
        break;
    case REMARK_STEP_TOO_LONG:
        text_addf(out,
                  "%s controls no error: a step at t = %.6g s may be off by %.2g times the "
                  "tolerance; take a smaller step=, or another method",
                  r->what, r->t, r->size);
        break;
    case REMARK_ENERGY_OPEN:
        text_addf(out,
                  "%.2g J come or go by themselves, of %.2g J that were stored at most: the motion "
                  "can't be right; take a smaller rtol or step=, or another method",
                  r->size, r->to);
        break;
    case REMARK_NEAR_SINGULAR:
        text_addf(out,
                  "passed near a singular position, first at t = %.6g s: rounding leaves its mark "
                  "there at any tolerance; check=on measures what",
                  r->t);
        break;
    case REMARK_FAR_OFF:
        text_addf(out, "finer runs end elsewhere, %.2g from this one at most; take a smaller %s",
                  r->size, r->what);
        break;
    case REMARK_UNRESOLVED:
        if (r->more != NULL)
            text_addf(out, "not resolved: a finer run fails: %s", r->more);
        else
            text_addf(out,
                      "not resolved: finer runs end elsewhere, each of them; take a smaller "
                      "%s, or a shorter run",
                      r->what);
        break;
    default:
        break;
    }
}

static void write_happened(const Remark *r, Text *out)
{
    switch (r->kind) {
    case REMARK_SETTLES:
        text_addf(out,
                  "%s switches ever faster: from t = %.9g s on, where it still leaves 0 at %.2g a "
                  "second, the motion is taken to stay there",
                  r->what, r->t, r->size);
        break;
    case REMARK_IMPACTS:
        text_addf(out, "%s: %d impact%s", r->what, r->count, r->count == 1 ? "" : "s");
        if (r->of > 0)
            text_addf(out, ", %d together with others, by Poisson's hypothesis", r->of);
        if (isfinite(r->size))
            text_addf(out, ", %.6g J lost", r->size);
        if (isfinite(r->t))
            text_addf(out, "; at rest from t = %.9g s on", r->t);
        break;
    case REMARK_SHARED:
        text_addf(out, "%s at t = %.9g s: %s", r->what, fabs(r->t) < DBL_MIN ? 0 : r->t, r->others);
        if (isfinite(r->size))
            text_addf(out, ", %.6g J are lost", r->size);
        break;
    case REMARK_SHARED_ON:
        text_addf(out, "ideal switches do so %d more times", r->count);
        if (isfinite(r->size))
            text_addf(out, ": %.6g J are lost in all", r->size);
        break;
    case REMARK_EVENT_FROM_START:
        text_addf(out,
                  "event %s: %s holds at the start; it must be false before it can become true",
                  r->what, r->more);
        break;
    case REMARK_EVENT:
        text_addf(out, "event %s: %s became true ", r->what, r->more);
        write_times(r, out);
        break;
    case REMARK_EVENT_RESTS:
        text_addf(out, "event %s: at rest from t = %.9g s ", r->what, r->t);
        if (isfinite(r->size))
            text_addf(out, "to t = %.9g s", r->size);
        else
            text_add(out, "on");
        if (r->count > 1)
            text_addf(out, ", and %d time%s before", r->count - 1, r->count == 2 ? "" : "s");
        break;
    case REMARK_EVENT_ENDED:
    case REMARK_EVENT_ENDED_FIRST:
    case REMARK_BOUND_MET:
        text_addf(out, "event %s ended the run at t = %.9g s: %s%s", r->what, r->t, r->more,
                  r->kind == REMARK_EVENT_ENDED_FIRST ? " holds at the start" : " became true");
        break;
    default:
        break;
    }
}

void remark_write(const Remark *r, Text *out)
{
    static const bool warns[REMARK_KINDS] = {
#define REMARK(kind, warning) [REMARK_##kind] = (warning),
#include "simulate/equations/remark.def"
#undef REMARK
    };

    text_add(out, warns[r->kind] ? "warning: " : "");
    write_start(r, out);
    write_steps(r, out);
    write_happened(r, out);
}

void remarks_write(const Remarks *r, Text *out)
{
    for (int i = 0; i < r->list.count; i++) {
        remark_write(&r->list.at[i], out);
        text_char(out, '\n');
    }
}
