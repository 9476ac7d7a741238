/* family_machine_jumps.c: machines in which something jumps, against equations of another kind
 *
 * Random machines with switches and diodes, ideal or not, sampled control, and events that set
 * speeds and what networks store: what is told of their runs is held against the oracle of
 * machine_hybrid.h, which encloses each instant itself. */
#include "machine_hybrid_draw.h"

static Verdict machine_jumps(Member *member)
{
    static Hybrid h;
    static Instant now;
    static Asks asks;
    Kit kit = kit_new();
    Real y[MOST_STATES];
    double at = 0;
    Verdict verdict = AGREES;
    bool known = true;

    while (!draw_hybrid(member, &h, true))
        ;
    draw_tree(member, &h.d, member_one_of(member, 3));
    if (chance(member, 0.2))
        write_line(&h.d.script, "form embedded");
    write_line(&h.d.script, "simulate 0.5 every=0.1 rtol=1e-9 atol=1e-11 method=%s",
               draw_method(member));
    memcpy(y, h.d.y, sizeof y);
    if (do_told(member, &kit, h.d.script.text) != CT_OK)
        verdict = REFUSED;
    if (verdict == AGREES && !hybrid_starts(&h, y))
        verdict = REFUSED;
    for (int part = 0; part < 4 && verdict == AGREES && known; part++) {
        const double to = part == 3 ? 0.4999 : 0.0131 + 0.163 * part;

        if (!hybrid_runs(&h, &at, to, y) || h.unsure)
            known = false;
        if (!known)
            break;
        if (h.stopped) {
            verdict = keeps(member, "when it stops", fabs(kit_value(&kit, "t") - at), 1e-7)
                          ? AGREES
                          : DISAGREES;
            break;
        }
        if (at - h.last < 1e-6)
            continue;
        unpack(&h.d.m, y, &now);
        if (!instant_solve(&h.d.m, &now))
            verdict = REFUSED;
        if (verdict == AGREES) {
            ask_all(&h.d.m, &now, &asks);
            verdict = compare(member, &kit, &asks, at, 3e-6);
        }
    }
    tell(member, "%d jumped by %.3g%s\n", h.happened, at, h.unsure ? ", unsure" : "");
    if (!known && verdict == AGREES)
        verdict = REFUSED;
    kit_free(&kit);
    return verdict;
}

/* What a run with jumps says of its own error at a coarse tolerance is not too low. */
static Verdict jumps_tell_their_error(Member *member)
{
    static Hybrid h;
    static Instant now;
    Kit kit = kit_new();
    Real y[MOST_STATES];
    ct_figures f;
    Verdict verdict = AGREES;
    double error = 0, at = 0;

    while (!draw_hybrid(member, &h, false))
        ;
    draw_tree(member, &h.d, member_one_of(member, 3));
    write_line(&h.d.script, "simulate 0.4 every=0.1 rtol=%.3g method=%s check=on",
               member_decades(member, 1e-7, 1e-4), draw_method(member));
    memcpy(y, h.d.y, sizeof y);
    if (do_told(member, &kit, h.d.script.text) != CT_OK || !hybrid_starts(&h, y) ||
        !hybrid_runs(&h, &at, 0.4, y) || h.unsure || at - h.last < 1e-3 ||
        !ct_run_figures(kit.session, 0, &f) || isnan(f.global_error))
        verdict = REFUSED;
    unpack(&h.d.m, y, &now);
    for (int c = 0; c < h.d.m.coordinates && verdict == AGREES; c++) {
        char text[40];

        error = fmax(error, fabs(kit_value(&kit, h.d.m.coordinate[c].name) - now.q[c]));
        (void)snprintf(text, sizeof text, "%s'", h.d.m.coordinate[c].name);
        error = fmax(error, fabs(kit_value(&kit, text) - coordinate_row(&h.d.m, &now, c).rate));
    }
    if (verdict == AGREES &&
        !keeps(member, "error of what is told", error / (f.global_error + 1e-9), 10))
        verdict = DISAGREES;
    tell(member, "%.3g, told %.3g; %d jumped\n", error, f.global_error, h.happened);
    kit_free(&kit);
    return verdict;
}

static const Family families[] = {
    {"machines jump where and as their parts do", 6, 0.5, 0, machine_jumps},
    {"machines that jump tell errors that are not too low", 4, 0.6, 0, jumps_tell_their_error},
};

int main(int argc, char **argv)
{
    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
