/* family_friction_limits.c: friction beside stops, backlash, one-way clutches and a diode, against
 * time stepping
 *
 * Masses in a row, on joints along or about an axis, rub on the ground with a constant bound or by
 * their load, and on their neighbours; stops, play and one-way clutches limit them; a motor behind
 * an ideal diode may drive the first. The oracle knows no modes: in a step of length h
 *
 *     M (v' - v) = h f + sum of w_k P_k
 *     abs P_k <= h T_k,  P_k = -h T_k sign(w_k v') where it moves
 *     P_k >= 0,  w_k v' + e w_k v <= 0,  one of the two 0, where a limit is met half a step on
 *     i' = max(0, i + h (E - R i' - K v)/L)
 *
 * (Moreau), P by projected sweeps. One limit alone has e above 0: of several an impact has no
 * agreed solution. The differences of the steps h, h/2 and h/4 bound what cotree may differ by. */
#include "../unit/session_kit.h"
#include "base/text.h"
#include "family.h"

#include <math.h>
#include <string.h>

enum { MOST = 3, PARTS = 6 * MOST, SWEEPS = 400, STEPS = 6000, LEVELS = 3 };

typedef enum Kind { RUBS, RUBS_BY_LOAD, DRIVES_ALONG, ENDS, GIVES } Kind;

/* second -1: the ground; of limits sign*(x_first - x_second) <= gap */
typedef struct Part {
    Kind kind;
    int first, second, sign;
    double bound; /* of friction: T, or T over the load; of what gives: its stiffness */
    double gap, e, damping;
} Part;

typedef struct Row {
    int count, parts;
    double mass[MOST], spring[MOST], constant[MOST], swing[MOST], pace[MOST], phase[MOST];
    double pressing[MOST]; /* amplitude of a force across, at the pace */
    double place[MOST], speed[MOST];
    Part part[PARTS];
    bool has_motor;
    double voltage, frequency, resistance, inductance, constant_of_motor;
    double end;
} Row;

typedef struct State {
    double x[MOST], v[MOST], current, lost;
} State;

/* --- the oracle --- */

static double between(const Part *p, const double *of)
{
    return p->sign * (of[p->first] - (p->second >= 0 ? of[p->second] : 0));
}

static void push(const Row *r, const Part *p, double impulse, double *v)
{
    v[p->first] += p->sign * impulse / r->mass[p->first];
    if (p->second >= 0)
        v[p->second] -= p->sign * impulse / r->mass[p->second];
}

static double load_of(const Row *r, int i, double t)
{
    return r->mass[i] * 9.81 + r->pressing[i] * sin(r->pace[i] * t);
}

/* the largest impulse, or 0 of what has none; *is_limit: it pushes apart alone */
static double most_of(const Row *r, const Part *p, double t, double h, const State *at,
                      bool *is_limit)
{
    *is_limit = p->kind == ENDS || p->kind == DRIVES_ALONG;
    switch (p->kind) {
    case RUBS:
        return h * p->bound;
    case RUBS_BY_LOAD:
        return h * p->bound * fabs(load_of(r, p->first, t));
    case DRIVES_ALONG:
        return p->bound > 0 ? h * p->bound : INFINITY;
    case ENDS:
        return between(p, at->x) + h / 2 * between(p, at->v) >= p->gap ? INFINITY : 0;
    default:
        return 0;
    }
}

/* impulses by sweeps */
static void hold(const Row *r, double t, double h, const State *before, double *v, double *impulse)
{
    for (int k = 0; k < r->parts; k++)
        push(r, &r->part[k], impulse[k], v);
    for (int turn = 0; turn < SWEEPS; turn++) {
        double moved = 0;

        for (int k = 0; k < r->parts; k++) {
            const Part *p = &r->part[k];
            const double own =
                1 / r->mass[p->first] + (p->second >= 0 ? 1 / r->mass[p->second] : 0);
            bool is_limit;
            const double most = most_of(r, p, t, h, before, &is_limit);
            const double wanted = impulse[k] - (between(p, v) + p->e * between(p, before->v)) / own;
            const double now =
                is_limit ? fmin(0, fmax(-most, wanted)) : fmin(most, fmax(-most, wanted));

            push(r, p, now - impulse[k], v);
            moved = fmax(moved, fabs(now - impulse[k]));
            impulse[k] = now;
        }
        if (moved < 1e-14 * h)
            break;
    }
}

static double force_on(const Row *r, int i, double t, const State *half)
{
    double force = r->constant[i] + r->swing[i] * sin(r->pace[i] * t + r->phase[i]) -
                   r->spring[i] * half->x[i];

    for (int k = 0; k < r->parts; k++) {
        const Part *p = &r->part[k];
        const double beyond = between(p, half->x) - p->gap;

        if (p->kind != GIVES || beyond <= 0 || (p->first != i && p->second != i))
            continue;
        force -= (p->first == i ? 1 : -1) * p->sign *
                 fmax(0, p->bound * beyond + p->damping * between(p, half->v));
    }
    return force;
}

static void step(const Row *r, double t, double h, State *s, double *impulse)
{
    const State before = *s;
    State half = *s;
    double drive = 0;

    for (int i = 0; i < r->count; i++)
        half.x[i] += h / 2 * s->v[i];
    if (r->has_motor) {
        const double l = r->inductance, voltage = r->voltage * sin(r->frequency * (t + h / 2));
        const double now =
            fmax(0, (l * s->current + h * (voltage - r->constant_of_motor * s->v[0])) /
                        (l + h * r->resistance));

        drive = r->constant_of_motor * (s->current + now) / 2;
        s->current = now;
    }
    for (int i = 0; i < r->count; i++)
        s->v[i] += h / r->mass[i] * (force_on(r, i, t + h / 2, &half) + (i == 0 ? drive : 0));
    hold(r, t + h / 2, h, &before, s->v, impulse);
    for (int i = 0; i < r->count; i++)
        s->x[i] += h / 2 * (before.v[i] + s->v[i]);
    for (int k = 0; k < r->parts; k++)
        if (r->part[k].kind == RUBS || r->part[k].kind == RUBS_BY_LOAD)
            s->lost -=
                impulse[k] * (between(&r->part[k], before.v) + between(&r->part[k], s->v)) / 2;
}

static void step_through(const Row *r, int steps, State *out)
{
    const double h = r->end / steps;
    double impulse[PARTS] = {0};

    *out = (State){0};
    memcpy(out->x, r->place, sizeof r->place);
    memcpy(out->v, r->speed, sizeof r->speed);
    for (int k = 0; k < steps; k++)
        step(r, k * h, h, out, impulse);
}

/* --- a member --- */

static void add_part(Row *r, Part part)
{
    part.sign = part.sign == 0 ? 1 : part.sign;
    r->part[r->parts++] = part;
}

static void draw_limits(Member *member, Row *r, int i, bool bounces)
{
    const double gap = member_between(member, 0.05, 0.5);
    const double e = bounces ? member_between(member, 0.2, 0.9) : 0;
    const bool gives = !bounces && member_one_of(member, 4) == 0;
    Part p = {.kind = gives ? GIVES : ENDS, .first = i, .second = -1, .gap = gap, .e = e};

    if (gives) {
        p.bound = member_decades(member, 100, 3000);
        p.damping = member_one_of(member, 2) == 0 ? 0 : member_between(member, 0, 20);
    }
    if (i > 0 && member_one_of(member, 2) == 0)
        p.second = i - 1;
    for (p.sign = -1; p.sign <= 1; p.sign += 2)
        add_part(r, p);
}

static void draw(Member *member, Row *r)
{
    const bool bounces = member_one_of(member, 2) == 0;
    int limited = 0;

    *r = (Row){.count = 1 + member_one_of(member, MOST), .end = member_between(member, 0.5, 2.5)};
    for (int i = 0; i < r->count; i++) {
        r->mass[i] = member_between(member, 0.3, 4);
        r->spring[i] = member_one_of(member, 2) == 0 ? 0 : member_between(member, 1, 30);
        r->constant[i] = member_one_of(member, 2) == 0 ? 0 : member_between(member, -6, 6);
        r->swing[i] = member_one_of(member, 3) == 0 ? 0 : member_between(member, 2, 15);
        r->pace[i] = member_between(member, 0.5, 8);
        r->phase[i] = member_between(member, 0, 6);
        r->speed[i] = member_one_of(member, 2) == 0 ? 0 : member_between(member, -1, 1);
        if (member_one_of(member, 3) > 0)
            add_part(r, (Part){.kind = RUBS,
                               .first = i,
                               .second = -1,
                               .bound = member_between(member, 0.3, 4)});
        else {
            r->pressing[i] = member_between(member, -1, 1) * r->mass[i] * 9;
            add_part(r, (Part){.kind = RUBS_BY_LOAD,
                               .first = i,
                               .second = -1,
                               .bound = member_between(member, 0.05, 0.4)});
        }
        if (i > 0 && member_one_of(member, 3) == 0)
            add_part(r, (Part){.kind = RUBS,
                               .first = i,
                               .second = i - 1,
                               .bound = member_between(member, 0.3, 4)});
        if (i > 0 && !bounces && member_one_of(member, 3) == 0)
            add_part(
                r,
                (Part){.kind = DRIVES_ALONG,
                       .first = i,
                       .second = i - 1,
                       .bound = member_one_of(member, 2) == 0 ? 0 : member_between(member, 1, 10)});
        else if (limited == 0 || (!bounces && member_one_of(member, 2) == 0)) {
            draw_limits(member, r, i, bounces);
            limited++;
        }
    }
    for (int k = 0; k < r->parts; k++) /* a start that a rigid one excludes is refused */
        if (r->part[k].kind == DRIVES_ALONG && r->part[k].bound == 0)
            r->speed[r->part[k].first] =
                fmin(r->speed[r->part[k].first], r->speed[r->part[k].second]);
    if (member_one_of(member, 3) == 0) {
        r->has_motor = true;
        r->voltage = member_between(member, 2, 12);
        r->frequency = member_between(member, 3, 60);
        r->resistance = member_between(member, 0.3, 3);
        r->inductance = member_decades(member, 5e-3, 0.2);
        r->constant_of_motor = member_between(member, 0.2, 2);
    }
}

static void write_part(const Row *r, int k, const char *bound, Text *out)
{
    const Part *p = &r->part[k];
    const bool turns = strcmp(bound, "torque") == 0;

    if (p->kind == RUBS && p->second < 0)
        text_addf(out, "friction f%d s%d %s=%.17g\n", k, p->first, bound, p->bound);
    else if (p->kind == RUBS)
        text_addf(out, "clutch f%d s%d s%d %s=%.17g\n", k, p->first, p->second, bound, p->bound);
    else if (p->kind == RUBS_BY_LOAD)
        text_addf(out, "friction f%d s%d mu=%.17g%s\n", k, p->first, p->bound,
                  turns ? " radius=1" : "");
    else if (p->kind == DRIVES_ALONG && p->bound > 0)
        text_addf(out, "oneway o%d s%d s%d %s=%.17g\n", k, p->first, p->second, bound, p->bound);
    else if (p->kind == DRIVES_ALONG)
        text_addf(out, "oneway o%d s%d s%d\n", k, p->first, p->second);
    else if (p->sign > 0)
        return; /* written with the other end */
    else if (p->second < 0)
        text_addf(out, "stop w%d s%d low=%.17g high=%.17g", k, p->first, -p->gap, p->gap);
    else
        text_addf(out, "backlash w%d s%d s%d gap=%.17g", k, p->first, p->second, 2 * p->gap);
    if (p->kind == GIVES)
        text_addf(out, " k=%.17g d=%.17g\n", p->bound, p->damping);
    else if (p->kind == ENDS)
        text_addf(out, " e=%.17g\n", p->e);
}

static void write_row(Member *member, const Row *r, Text *out)
{
    const bool turns = member_one_of(member, 2) == 0;
    const char *bound = turns ? "torque" : "force";

    text_add(out, "scene planar\ngravity [0, -9.81]\n");
    for (int i = 0; i < r->count; i++) {
        text_addf(out, "body m%d mass=%.17g inertia=%.17g\n%s s%d ground m%d%s\n", i, r->mass[i],
                  turns ? r->mass[i] : 0.1, turns ? "revolute" : "prismatic", i, i,
                  turns ? "" : " axis=x");
        text_addf(out, "actuator l%d s%d %s=%.17g + %.17g*sin(%.17g*t + %.17g)\n", i, i, bound,
                  r->constant[i], r->swing[i], r->pace[i], r->phase[i]);
        text_addf(out, "spring k%d s%d k=%.17g\n", i, i, r->spring[i]);
        if (r->pressing[i] != 0)
            text_addf(out, "force p%d m%d [0, %.17g*sin(%.17g*t)]\n", i, i, -r->pressing[i],
                      r->pace[i]);
    }
    for (int k = 0; k < r->parts; k++)
        write_part(r, k, bound, out);
    if (r->has_motor)
        text_addf(out,
                  "vsource V a 0 %.17g*sin(%.17g*t)\ndiode D a b\n"
                  "motor M s0 b 0 R=%.17g L=%.17g Kt=%.17g\n",
                  r->voltage, r->frequency, r->resistance, r->inductance, r->constant_of_motor);
    if (member_one_of(member, 3) == 0)
        text_add(out, "tree absolute\n");
    if (member_one_of(member, 3) == 0)
        text_add(out, "form embedded\n");
    for (int i = 0; i < r->count; i++)
        text_addf(out, "init s%d = %.17g, s%d' = %.17g\n", i, r->place[i], i, r->speed[i]);
}

/* Between terminals there are no loads and no stops: constant bounds and one-way clutches are in
 * their place. */
static void limit_to_terminals(Row *r)
{
    int kept = 0;

    for (int k = 0; k < r->parts; k++) {
        Part p = r->part[k];

        if ((p.kind == ENDS || p.kind == GIVES) && p.sign < 0)
            continue;
        if (p.kind == RUBS_BY_LOAD)
            p = (Part){RUBS, p.first, p.second, 1, .bound = 8 * p.bound};
        else if (p.kind != RUBS)
            p = (Part){DRIVES_ALONG, p.first, p.second, 1, .bound = p.gap > 0.3 ? 0 : 10 * p.gap};
        if (p.kind == DRIVES_ALONG && p.bound == 0)
            r->speed[p.first] = fmin(r->speed[p.first], p.second < 0 ? 0 : r->speed[p.second]);
        r->part[kept++] = p;
    }
    r->parts = kept;
}

/* the same between the terminals of shafts or slides */
static void write_terminals(Member *member, const Row *r, Text *out)
{
    const bool turns = member_one_of(member, 2) == 0;
    const char *bound = turns ? "torque" : "force", *rate = turns ? "w" : "v";

    for (int i = 0; i < r->count; i++) {
        text_addf(out, "%s m%d a%d 0 %s=%.17g\ninit m%d.%s = %.17g\n", turns ? "flywheel" : "slug",
                  i, i, turns ? "J" : "m", r->mass[i], i, rate, r->speed[i]);
        text_addf(out, "%ssource l%d a%d 0 %.17g + %.17g*sin(%.17g*t + %.17g)\n", bound, i, i,
                  r->constant[i], r->swing[i], r->pace[i], r->phase[i]);
        if (r->spring[i] > 0)
            text_addf(out, "%s k%d a%d 0 k=%.17g\ninit k%d.%s = 0\n", turns ? "shaft" : "rod", i, i,
                      r->spring[i], i, bound);
    }
    for (int k = 0; k < r->parts; k++) {
        const Part *p = &r->part[k];
        char ends[16];

        if (p->second < 0)
            (void)snprintf(ends, sizeof ends, "a%d 0", p->first);
        else
            (void)snprintf(ends, sizeof ends, "a%d a%d", p->first, p->second);
        if (p->kind == RUBS)
            text_addf(out, "%s f%d %s %s=%.17g\n", p->second < 0 ? "friction" : "clutch", k, ends,
                      bound, p->bound);
        else if (p->bound > 0)
            text_addf(out, "oneway o%d %s %s=%.17g\n", k, ends, bound, p->bound);
        else
            text_addf(out, "oneway o%d %s\n", k, ends);
    }
    if (r->has_motor)
        text_addf(out,
                  "vsource V p 0 %.17g*sin(%.17g*t)\ndiode D p q\nresistor R q n %.17g\n"
                  "inductor L n e %.17g\nvsource E e 0 %.17g*m0.%s\n"
                  "%ssource M a0 0 %.17g*L.i\ninit L.i = 0\n",
                  r->voltage, r->frequency, r->resistance, r->inductance, r->constant_of_motor,
                  rate, bound, r->constant_of_motor);
}

/* the value beside that of the finest steps */
static bool is_near(Member *member, Kit *kit, const char *name, double coarse, double middle,
                    double fine)
{
    const double unsure = 6 * fmax(fabs(fine - middle), fabs(middle - coarse) / 2);

    return keeps(member, name, fabs(kit_value(kit, name) - fine), 2e-3 * (1 + fabs(fine)) + unsure);
}

static Verdict compare(Member *member, const Row *r, Kit *kit, bool joints)
{
    State at[LEVELS];
    bool right = true;

    for (int k = 0; k < LEVELS; k++)
        step_through(r, STEPS << k, &at[k]);
    for (int i = 0; i < r->count; i++) {
        char name[64];

        if (joints)
            (void)snprintf(name, sizeof name, "s%d'", i);
        else
            (void)snprintf(name, sizeof name, "m%d.momentum/%.17g", i, r->mass[i]);
        right = is_near(member, kit, name, at[0].v[i], at[1].v[i], at[2].v[i]) && right;
        (void)snprintf(name, sizeof name, "s%d", i);
        if (joints)
            right = is_near(member, kit, name, at[0].x[i], at[1].x[i], at[2].x[i]) && right;
    }
    if (r->has_motor)
        right = is_near(member, kit, joints ? "M.i" : "L.i", at[0].current, at[1].current,
                        at[2].current) &&
                right;
    return right ? AGREES : DISAGREES;
}

static Verdict run_row(Member *member, bool joints)
{
    static const char *const methods[] = {"auto", "dop853", "radau", "bdf", "ida"};
    Row r;
    Text text = {0};
    Kit kit = kit_new();
    Verdict verdict = DISAGREES;

    draw(member, &r);
    if (joints) {
        write_row(member, &r, &text);
    } else {
        limit_to_terminals(&r);
        write_terminals(member, &r, &text);
    }
    text_addf(&text, "simulate %.17g method=%s rtol=1e-8\n", r.end,
              methods[member_one_of(member, 5)]);
    tell(member, "%s", text.at);
    if (kit_do(&kit, text.at) == CT_OK)
        verdict = compare(member, &r, &kit, joints);
    else
        tell(member, "refused: %s\n", kit.error.message);
    text_free(&text);
    kit_free(&kit);
    return verdict;
}

static Verdict masses_rub_within_limits(Member *member)
{
    return run_row(member, true);
}

static Verdict shafts_and_slides_rub_within_limits(Member *member)
{
    return run_row(member, false);
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"masses_rub_within_limits", 60, 0, 0, masses_rub_within_limits},
        {"shafts_and_slides_rub_within_limits", 40, 0, 0, shafts_and_slides_rub_within_limits},
    };

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
