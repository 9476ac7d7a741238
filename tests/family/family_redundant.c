/* family_redundant.c: what is asked at an instant where the rows that a start has chosen are none
 *
 * A plate on three equal and parallel cranks goes round in a circle: 4 equations of two loops, of
 * which any position leaves 3. Which one may be left out changes on the way: the forces that cancel
 * each other point along the cranks, and the lever of one is 0 where the two other pins are in line
 * with them. There runs, events, inverse runs and modes are held against I phi'' = M with
 * I = sum m l^2 / 3 + m_plate l^2. */
#include "../unit/session_kit.h"
#include "family.h"
#include "mechanisms.h"

typedef struct Plate {
    double length, pin[3][2], masses[3], plate;
    double from, to; /* rad: where it starts, and where it is asked */
    Script script;
} Plate;

static double inertia(const Plate *p)
{
    return (p->masses[0] + p->masses[1] + p->masses[2]) / 3 * p->length * p->length +
           p->plate * p->length * p->length;
}

/* an angle at which a row vanishes, or two pins are in line along the cranks */
static double critical_angle(Member *member, const Plate *p)
{
    const int i = draw_one_of(member, 3), j = (i + 1) % 3;
    const double half_turns = acos(-1) * draw_one_of(member, 2);

    if (draw_one_of(member, 2))
        return acos(0) * draw_one_of(member, 4);
    return atan2(p->pin[j][1] - p->pin[i][1], p->pin[j][0] - p->pin[i][0]) + half_turns;
}

static void draw_plate(Member *member, Plate *p)
{
    const double turn = draw(member, -3, 3);

    *p = (Plate){.length = draw(member, 0.5, 1.5), .plate = draw(member, 0.5, 3)};
    for (int i = 1; i < 3; i++) {
        const double reach = draw(member, 0.5, 1.5);
        const double angle = turn + (i == 1 ? 0 : draw(member, 0.7, 2.4));

        p->pin[i][0] = reach * cos(angle);
        p->pin[i][1] = reach * sin(angle);
    }
    for (int i = 0; i < 3; i++)
        p->masses[i] = draw(member, 0.3, 2);
    p->to = critical_angle(member, p);
    p->from = p->to - draw(member, 0.2, 1.4) * (draw_one_of(member, 2) ? 1 : -1);
}

/* one hinge of each of two cranks closes a loop */
static void write_tree_of(Member *member, Script *s, bool of_angles)
{
    const int first = draw_one_of(member, 3), second = (first + 1 + draw_one_of(member, 2)) % 3;

    switch (of_angles ? 2 * draw_one_of(member, 2) : draw_one_of(member, 3)) {
    case 0:
        return;
    case 1:
        write_line(s, "tree absolute");
        return;
    default:
        write_line(s, "cotree %c%d %c%d", draw_one_of(member, 2) ? 'h' : 'l', first,
                   draw_one_of(member, 2) ? 'h' : 'l', second);
    }
}

static void write_plate(Member *member, Plate *p, bool of_angles)
{
    Script *s = &p->script;
    const double x = p->length * cos(p->from), y = p->length * sin(p->from);

    write_line(s, "scene planar\ngravity [0, 0]\nbody k mass=%.17g inertia=1", p->plate);
    for (int i = 0; i < 3; i++) {
        char name[16];

        (void)snprintf(name, sizeof name, "c%d", i);
        write_rod(s, name, p->masses[i], p->length);
        write_line(s, "arm g%d ground [%.17g, %.17g]; arm k%d k [%.17g, %.17g]", i, p->pin[i][0],
                   p->pin[i][1], i, p->pin[i][0], p->pin[i][1]);
        write_line(s, "revolute h%d g%d c%da; revolute l%d c%db k%d", i, i, i, i, i, i);
        write_line(s, "guess c%d.x=%.17g, c%d.y=%.17g, c%d.theta=%.17g", i, p->pin[i][0] + x / 2, i,
                   p->pin[i][1] + y / 2, i, p->from);
        write_line(s, "guess h%d=%.17g, l%d=%.17g", i, p->from, i, -p->from);
    }
    write_line(s, "guess k.x=%.17g, k.y=%.17g, k.theta=0", x, y);
    write_tree_of(member, s, of_angles);
    if (draw_one_of(member, 3) == 0)
        write_line(s, "form embedded");
}

typedef struct Expected {
    const char *what;
    double value;
} Expected;

#define BOUND 1e-6 /* of the larger one of 1 and the value */

/* whether the program says that it knows less of eigenvalues than is compared */
static bool is_marked(const char *text)
{
    const char *at = text != NULL ? strstr(text, "? 0 within ") : NULL;
    double within = 0;

    return at != NULL && sscanf(at, "? 0 within %lf", &within) == 1 && within > BOUND;
}

static Verdict run_and_compare(Member *member, const Plate *p, const Expected *expected, int count)
{
    Kit kit = kit_new();
    Verdict verdict = AGREES;
    ct_status status = kit_do(&kit, p->script.text);

    const bool marked = is_marked(kit.text);

    tell(member, "%s", p->script.text);
    if (status != CT_OK) {
        tell(member, "refused: %s\n", kit.error.message);
        verdict = DISAGREES;
    }
    for (int k = 0; k < count && status == CT_OK; k++) {
        const double value = kit_value(&kit, expected[k].what);
        const double bound = BOUND * fmax(1, fabs(expected[k].value));

        tell(member, "%s = %.12g, expected %.12g\n", expected[k].what, value, expected[k].value);
        if (!(fabs(value - expected[k].value) <= bound))
            verdict = marked ? REFUSED : DISAGREES;
    }
    kit_free(&kit);
    return verdict;
}

static Verdict efforts_are_those_of_the_motion(Member *member)
{
    Plate p;
    double rate, torque;

    draw_plate(member, &p);
    write_plate(member, &p, false);
    rate = p.to - p.from;
    torque = 2 * rate * inertia(&p);
    write_line(&p.script, "driver D h%d = %.17g + %.17g*t^2\ninverse 1.5 every=0.25",
               draw_one_of(member, 3), p.from, rate);
    return run_and_compare(member, &p,
                           (Expected[]){{"D.effort at 0.5", torque},
                                        {"D.effort at 1", torque},
                                        {"D.effort at 1.5", torque}},
                           3);
}

static Verdict events_give_speeds_there(Member *member)
{
    Plate p;
    const double part = draw(member, -1, 1);
    const int which = draw_one_of(member, 3);
    double rate;

    draw_plate(member, &p);
    write_plate(member, &p, false);
    rate = p.to - p.from;
    write_line(&p.script, "init h%d = %.17g, h%d' = %.17g", which, p.from, which, rate);
    write_line(&p.script, "event e when=t > 1 h%d'=%.17g*h%d'", which, part, which);
    write_line(&p.script, "simulate 1.5 rtol=1e-9");
    return run_and_compare(
        member, &p,
        (Expected[]){{"h0", p.to + part * rate / 2},
                     {"h1'", part * rate},
                     {"l2'", -part * rate},
                     {"k.vx", -p.length * part * rate * sin(p.to + part * rate / 2)}},
        4);
}

/* rest + (from - rest) cos(w t) + rate/w sin(w t) is `to` at t = 1. About an instant in motion the
 * eigenvalues are those of angles; positions change with time against these. */
static Verdict modes_are_those_of_the_spring(Member *member)
{
    Plate p;
    const double w = draw(member, 0.7, 2), rate = draw(member, -1, 1);
    double rest;

    draw_plate(member, &p);
    write_plate(member, &p, true);
    rest = (p.to - p.from * cos(w) - rate / w * sin(w)) / (1 - cos(w));
    write_line(&p.script, "spring s h0 k=%.17g rest=%.17g", w * w * inertia(&p), rest);
    write_line(&p.script, "init h0 = %.17g, h0' = %.17g", p.from, rate);
    write_line(&p.script, "simulate 2 rtol=1e-10\nmodes at=1");
    return run_and_compare(member, &p, (Expected[]){{"h0 at 1", p.to}, {"modes.omega(1)", w}}, 2);
}

/* What a circuit reads of a reaction that loops leave undetermined is what is told of it. */
static Verdict circuits_read_the_reactions_that_are_told(Member *member)
{
    static const char *const directions[] = {"fx", "fy"};
    Plate p;
    Kit kit = kit_new();
    Verdict verdict = AGREES;
    const int which = draw_one_of(member, 3);
    const char *direction = directions[draw_one_of(member, 2)];
    char reaction[32];
    double read, told;

    draw_plate(member, &p);
    write_plate(member, &p, false);
    (void)snprintf(reaction, sizeof reaction, "%c%d.%s", draw_one_of(member, 2) ? 'h' : 'l', which,
                   direction);
    write_line(&p.script, "init h0 = %.17g, h0' = %.17g", p.from, p.to - p.from);
    write_line(&p.script, "sensor S %s a 0\nresistor R a 0 1\nsimulate 1", reaction);
    if (kit_do(&kit, p.script.text) != CT_OK)
        verdict = DISAGREES;
    read = kit_value(&kit, "R.v");
    told = kit_value(&kit, reaction);
    tell(member, "%s%s: read %.12g, told %.12g\n%s\n", p.script.text, reaction, read, told,
         kit.error.message);
    if (!(fabs(read - told) <= BOUND * fmax(1, fabs(told))))
        verdict = DISAGREES;
    kit_free(&kit);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"efforts_are_those_of_the_motion", 40, 0, 0, efforts_are_those_of_the_motion},
        {"events_give_speeds_there", 40, 0, 0, events_give_speeds_there},
        {"modes_are_those_of_the_spring", 40, 0.03, 0, modes_are_those_of_the_spring},
        {"circuits_read_the_reactions_that_are_told", 40, 0, 0,
         circuits_read_the_reactions_that_are_told},
    };

    return family_main(families, COUNT(families), argc, argv);
}
