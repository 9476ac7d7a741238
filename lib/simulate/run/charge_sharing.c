/* charge_sharing.c: charges and fluxes over a jump
 *
 * What becomes of states the network's own equations tell, by a step of vanishing length
 * (mode_search_jump()): impulses of current leave the charge of each cutset of capacitors as it
 * was, and impulses of voltage the flux of each circuit of coils, also through transformers and
 * amplifiers. A source may lie on their way, which its value bounds as before. It may not be all
 * that tells where a state jumps. */
#include "simulate/run/charge_sharing.h"

#include "base/memory.h"
#include "base/random.h"

#include <math.h>
#include <string.h>

#define JUMP     1e-6 /* of the largest of its kind, more than location may change it, */
#define ERRORS   100  /* and of the tolerance: what errors may */
#define AGREE    1e-5 /* of the largest of its kind: the step has a length, and switches leak */
#define FREE     1e-6 /* of the largest: a state that others move */
#define GAIN     1e-9 /* of the energy: rounding */
#define TOLD     3    /* times that are told one by one */
#define TOGETHER 6    /* names told of one time */

struct Shares {
    Probe *energy;
    bool is_known; /* of all that stores, and it follows from states */
    int times;
    double lost; /* J; NAN: not known of some */
};

void shares_free(Shares *shares)
{
    if (shares == NULL)
        return;
    probe_free(shares->energy);
    mem_free(shares);
}

/* --- kinds of states --- */

static const char *kind_of(const VariableIndex *whole, int state)
{
    const char *name = system_x(whole->system, state)->name;
    const char *kind = strrchr(name, '.');

    return kind != NULL ? kind + 1 : name;
}

/* the largest voltage or current so far of any edge, as the state is the one or the other */
static double largest_like(const ActiveRun *r, const char *kind)
{
    double largest = 0;

    for (Domain domain = 0; domain < DOMAIN_COUNT; domain++) {
        if (strcmp(kind, domain_across(domain)) == 0)
            largest = fmax(largest, mode_search_largest(r->mode_search, domain, false));
        if (strcmp(kind, domain_through(domain)) == 0)
            largest = fmax(largest, mode_search_largest(r->mode_search, domain, true));
    }
    return largest;
}

bool share_is_jump(const ActiveRun *r, int state, double from, double to)
{
    return fabs(to - from) >
           JUMP * fmax(largest_like(r, kind_of(phases_whole(r->phases)->layout, state)), fabs(to)) +
               ERRORS * r->phases->tolerance;
}

/* --- energy --- */

/* whether what every part stores is in the energies */
static bool are_energies_known(System *system)
{
    for (int i = 0; i < system_scalar_count(system); i++) {
        ScalarPair edge;

        if (system_scalar(system, i, &edge, NULL) == OK && edge.stores && !edge.energy_known)
            return false;
    }
    return true;
}

static bool open_shares(ActiveRun *r)
{
    const VariableIndex *l = phases_whole(r->phases)->layout;
    Expr energy =
        expr_add(system_arena(l->system), system_kinetic(l->system), system_potential(l->system));

    if (r->shares != NULL)
        return r->shares->energy != NULL;
    r->shares = NEW(Shares);
    r->shares->is_known =
        are_energies_known(l->system) && (expr_kinds(energy) & 1U << SYMBOL_ALGEBRAIC) == 0;
    return probe_new(l, &r->phases->parameters, &energy, 1, &r->shares->energy, NULL) == OK;
}

static double energy_at(const ActiveRun *r, const Phase *phase, double t, const double *y,
                        const double *x)
{
    const VariableIndex *l = phases_whole(r->phases)->layout;
    const RowValues row = {.t = t,
                           .references = y + variable_index_references(phase->layout),
                           .q = y,
                           .u = y + l->n,
                           .x = x};

    return probe_values(r->shares->energy, &row)[0];
}

/* --- sharing --- */

/* for each state, the largest of its kind */
static void find_sizes(const ActiveRun *r, const double *x, double *sizes)
{
    const VariableIndex *whole = phases_whole(r->phases)->layout;

    for (int i = 0; i < whole->nx; i++) {
        sizes[i] = ERRORS * r->phases->tolerance;
        for (int k = 0; k < whole->nx; k++)
            if (strcmp(kind_of(whole, k), kind_of(whole, i)) == 0)
                sizes[i] = fmax(sizes[i], fabs(x[k]));
    }
}

/* where a jump leads that begins elsewhere: by `moves` of the sizes of states */
static bool jump_from(const ActiveRun *r, const double *x, const double *moves, const double *sizes,
                      double *landed)
{
    const int nx = phases_whole(r->phases)->layout->nx;
    double *other = NEW_ARRAY(double, nx);
    bool sound;

    for (int i = 0; i < nx; i++)
        other[i] = x[i] + moves[i] * sizes[i];
    sound = mode_search_jump(r->mode_search, other, sizes, landed);
    mem_free(other);
    return sound;
}

/* whether something that is stored changes by what this state was */
static bool goes_somewhere(const ActiveRun *r, int state, const double *x, const double *now,
                           const double *sizes)
{
    const int nx = phases_whole(r->phases)->layout->nx;
    double *moves = NEW_ARRAY(double, nx);
    double *landed = NEW_ARRAY(double, nx);
    bool found = false;

    moves[state] = 1;
    if (jump_from(r, x, moves, sizes, landed))
        for (int i = 0; i < nx; i++)
            found = found || fabs(landed[i] - now[i]) > FREE * sizes[i];
    MEM_FREE(moves, landed);
    return found;
}

/* An op-amp's output hands charge on from stage to stage, as much as its input asks for. */
static bool hands_on(System *system)
{
    for (int i = 0; i < system_scalar_count(system); i++) {
        ScalarPair edge;

        if (system_scalar(system, i, &edge, NULL) == OK && edge.gives_any)
            return true;
    }
    return false;
}

/* Whether each state that jumps follows from what was stored, or is handed on: it isn't given by
 * sources alone, nor goes into nothing. What follows is seen by a move of all that was stored. */
static bool are_shared(const ActiveRun *r, const double *x, const double *now, const double *sizes)
{
    const int nx = phases_whole(r->phases)->layout->nx;
    double *moves = NEW_ARRAY(double, nx);
    double *landed = NEW_ARRAY(double, nx);
    uint64_t seed = 1;
    bool shared;

    for (int i = 0; i < nx; i++)
        moves[i] = random_unit(&seed);
    shared = jump_from(r, x, moves, sizes, landed);
    for (int i = 0; i < nx && shared; i++)
        shared = !share_is_jump(r, i, x[i], now[i]) || fabs(landed[i] - now[i]) > FREE * sizes[i] ||
                 goes_somewhere(r, i, x, now, sizes);
    MEM_FREE(moves, landed);
    return shared;
}

/* whether the phase can be where the jump leads; its own states go there, the whole into `now` */
static bool put_states(Phase *phase, double t, const double *landed, const double *sizes, int nx,
                       double *y, double *now)
{
    const VariableIndex *l = phase->layout;
    RowValues row;
    bool met;

    for (int i = 0; i < l->nx; i++)
        y[l->n + l->nu + i] = landed[phase->among_whole[i]];
    met = phase_states(phase, t, y, nx, &row, now);
    for (int i = 0; i < nx && met; i++)
        met = fabs(now[i] - landed[i]) <= AGREE * fmax(sizes[i], fabs(now[i]));
    return met;
}

/* --- what is said --- */

/* "C1 and C2 share their charge" */
static void report_sharers(const ActiveRun *r, const double *x, const double *now, Text *out)
{
    const VariableIndex *whole = phases_whole(r->phases)->layout;
    bool charge = false, flux = false;
    int count = 0, said = 0;

    for (int i = 0; i < whole->nx; i++)
        count += share_is_jump(r, i, x[i], now[i]);
    for (int i = 0; i < whole->nx && said < TOGETHER; i++) {
        const char *name = system_x(whole->system, i)->name;
        const char *kind = kind_of(whole, i);

        if (!share_is_jump(r, i, x[i], now[i]))
            continue;
        charge = charge || strcmp(kind, domain_across(DOMAIN_ELECTRICAL)) == 0;
        flux = flux || strcmp(kind, domain_through(DOMAIN_ELECTRICAL)) == 0;
        text_addf(out, "%s%.*s",
                  said == 0           ? ""
                  : said + 1 == count ? " and "
                                      : ", ",
                  (int)(kind - name - (kind > name)), name);
        said++;
    }
    text_addf(out, "%s share %s", count > said ? " ..." : "",
              charge && !flux   ? "their charge"
              : flux && !charge ? "their flux"
                                : "what they store");
}

static void tell(ActiveRun *r, const char *sides, double t, double lost, const double *x,
                 const double *now)
{
    Text sharers = {0};

    r->shares->lost += lost;
    if (r->shares->times++ >= TOLD)
        return;
    report_sharers(r, x, now, &sharers);
    remarks_add(
        &r->result->remarks,
        (Remark){.kind = REMARK_SHARED, .what = sides, .t = t, .others = sharers.at, .size = lost});
    text_free(&sharers);
}

void charge_sharing_report(ActiveRun *r)
{
    mem_keep(r);
    const Shares *shares = r->shares;

    if (shares == NULL || shares->times <= TOLD)
        return;
    remarks_add(
        &r->result->remarks,
        (Remark){.kind = REMARK_SHARED_ON, .count = shares->times - TOLD, .size = shares->lost});
}

/* What is stored may not grow: sources alone would have to give that. */
static bool is_given(const ActiveRun *r, Phase *phase, double t, const double *y, const double *x,
                     const double *now)
{
    const double was = energy_at(r, phase, t, y, x), is = energy_at(r, phase, t, y, now);

    return r->shares->is_known && is - was > GAIN * (fabs(is) + fabs(was)) &&
           !hands_on(phases_whole(r->phases)->layout->system);
}

/* J; NAN where the energy of something is not known */
static double energy_lost(ActiveRun *r, Phase *phase, double t, const bool *before, const double *y,
                          const double *x, const double *now, double *gained)
{
    const double was = energy_at(r, phase, t, y, x), is = energy_at(r, phase, t, y, now);
    const double work = mode_search_work(r->mode_search, x, before);
    const double lost = was - is + work;

    *gained = is - was;
    return r->shares->is_known && lost >= -GAIN * (fabs(was) + fabs(work)) ? fmax(0, lost) : NAN;
}

bool share_stored(ActiveRun *r, Phase *phase, double t, const bool *before, const char *sides,
                  double *y, double *x)
{
    mem_keep(r);
    const int nx = phases_whole(r->phases)->layout->nx;
    const size_t bytes = (size_t)phase->length * sizeof(double);
    double *sizes = NEW_ARRAY(double, nx);
    double *landed = NEW_ARRAY(double, nx);
    double *now = NEW_ARRAY(double, nx);
    double *kept = NEW_ARRAY(double, phase->length);
    bool met;

    memcpy(kept, y, bytes);
    find_sizes(r, x, sizes);
    met = open_shares(r) && mode_search_jump(r->mode_search, x, sizes, landed) &&
          put_states(phase, t, landed, sizes, nx, y, now) && are_shared(r, x, now, sizes) &&
          !is_given(r, phase, t, y, x, now);
    if (met) {
        double gained, lost;

        (void)mode_search_jump(r->mode_search, x, sizes, landed);
        lost = energy_lost(r, phase, t, before, y, x, now, &gained);
        tell(r, sides, t, lost, x, now);
        y[phase->length - 1] += gained;
        memcpy(x, now, (size_t)nx * sizeof(double));
    } else {
        memcpy(y, kept, bytes);
    }
    MEM_FREE(sizes, landed, now, kept);
    return met;
}
