/* test_suspension.c: the corner of a car, two wishbones on bushings, against Newton and Euler in
 * absolute coordinates (free_bodies.h) */
#include "../family/free_bodies.h"
#include "session_kit.h"

enum { LOWER, UPPER, UPRIGHT, BODIES };

static const char *const names[BODIES] = {"lower", "upper", "upright"};

static bool is_near(const char *name, double got, double expected, double within)
{
    const bool near = fabs(got - expected) <= within * (1 + fabs(expected));

    if (!near)
        (void)fprintf(stderr, "%s: %.15g, expected %.15g\n", name, got, expected);
    return near;
}

/* x outwards, y ahead, z up, from a point of the car's body; m, kg, N */
static FreeBodies corner(void)
{
    static const double k[6] = {4e6, 4e6, 5e5, 300, 300, 100}, d[6] = {2e3, 2e3, 500, 2, 2, 1};
    /* wishbones as plates with their centre between both seats and the ball */
    static const double seat[4][3] = {
        {0.1, 0.15, 0}, {0.1, -0.15, 0}, {0.15, 0.1, 0.3}, {0.15, -0.1, 0.3}};
    static const V ball[2] = {{{0.5, 0, -0.02}}, {{0.46, -0.02, 0.28}}};
    static const V centre[BODIES] = {{{0.25, 0, 0}}, {{0.27, 0, 0.29}}, {{0.55, 0, 0.12}}};
    static const double mass[BODIES] = {4, 2.5, 18};
    static const double inertia[BODIES][3] = {
        {0.05, 0.08, 0.12}, {0.02, 0.04, 0.05}, {0.6, 0.9, 0.6}};
    FreeBodies s = {.count = BODIES, .gravity = {{0, 0, -9.81}}};

    for (int i = 0; i < BODIES; i++) {
        s.body[i] = (FreeBody){.mass = mass[i], .q = {1}, .c = centre[i]};
        memcpy(s.body[i].inertia, inertia[i], sizeof inertia[i]);
    }
    s.body[UPRIGHT].push = (V){{300, -200, 5200}}; /* the road */
    for (int i = 0; i < 4; i++) {
        const V at = {{seat[i][0], seat[i][1], seat[i][2]}};
        Bush *bush = &s.bush[s.bushes++];

        *bush = (Bush){.tail = {.body = GROUND, .at = at, .turn = {1.5, 0}},
                       .tip = {.body = i / 2, .at = plus(at, -1, centre[i / 2]), .turn = {1.5, 0}}};
        for (int j = 0; j < 6; j++) {
            bush->k[j][j] = k[j];
            bush->d[j][j] = d[j];
        }
    }
    for (int i = 0; i < 2; i++)
        s.tie[s.ties++] = (Tie){.tail = {.body = i, .at = plus(ball[i], -1, centre[i])},
                                .tip = {.body = UPRIGHT, .at = plus(ball[i], -1, centre[UPRIGHT])}};
    s.tie[s.ties++] =
        (Tie){.tail = {.body = GROUND, .at = {{0.12, 0.12, 0.05}}},
              .tip = {.body = UPRIGHT, .at = plus((V){{0.5, 0.12, 0.05}}, -1, centre[UPRIGHT])},
              .kind = TIE_ROD,
              .length = 0.38};
    s.strut[s.struts++] = (Strut){.tail = {.body = GROUND, .at = {{0.2, 0, 0.6}}},
                                  .tip = {.body = LOWER, .at = {{0.1, 0, 0.02}}},
                                  .k = 4e4,
                                  .d = 2e3,
                                  .length = 0.75};
    return s;
}

/* --- the same in cotree --- */

static int write_spot(char *text, size_t room, const Spot *spot, const char *name)
{
    return snprintf(text, room, "arm %s %s [%.17g, %.17g, %.17g] rotation=x(%.17g)\n", name,
                    spot->body == GROUND ? "ground" : names[spot->body], spot->at.at[0],
                    spot->at.at[1], spot->at.at[2], spot->turn[0]);
}

static void write(const FreeBodies *s, char *text, size_t room)
{
    int at = snprintf(text, room, "gravity [0, 0, -9.81]\n");
    char tail[16], tip[16];

    for (int i = 0; i < s->count; i++) {
        const FreeBody *b = &s->body[i];

        at += snprintf(text + at, room - (size_t)at,
                       "body %s mass=%.17g inertia=[%.17g, %.17g, %.17g]\ninit %s.x = %.17g, "
                       "%s.y = %.17g, %s.z = %.17g, %s.q1 = 0, %s.q2 = 0, %s.q3 = 0\n",
                       names[i], b->mass, b->inertia[0], b->inertia[1], b->inertia[2], names[i],
                       b->c.at[0], names[i], b->c.at[1], names[i], b->c.at[2], names[i], names[i],
                       names[i]);
    }
    at += snprintf(text + at, room - (size_t)at, "force road upright [%.17g, %.17g, %.17g]\n",
                   s->body[UPRIGHT].push.at[0], s->body[UPRIGHT].push.at[1],
                   s->body[UPRIGHT].push.at[2]);
    for (int i = 0; i < s->bushes + s->ties + s->struts; i++) {
        const int tie = i - s->bushes, strut = tie - s->ties;
        const Spot *from = tie < 0     ? &s->bush[i].tail
                           : strut < 0 ? &s->tie[tie].tail
                                       : &s->strut[strut].tail;
        const Spot *to = tie < 0     ? &s->bush[i].tip
                         : strut < 0 ? &s->tie[tie].tip
                                     : &s->strut[strut].tip;

        (void)snprintf(tail, sizeof tail, "r%d", i);
        (void)snprintf(tip, sizeof tip, "s%d", i);
        at += write_spot(text + at, room - (size_t)at, from, tail);
        at += write_spot(text + at, room - (size_t)at, to, tip);
        if (tie < 0)
            at += snprintf(text + at, room - (size_t)at,
                           "bushing b%d r%d s%d k=[4e6, 4e6, 5e5, 300, 300, 100] "
                           "d=[2e3, 2e3, 500, 2, 2, 1]\n",
                           i, i, i);
        else if (strut >= 0)
            at += snprintf(text + at, room - (size_t)at,
                           "spring strut r%d s%d k=4e4 d=2e3 length=0.75\n", i, i);
        else if (s->tie[tie].kind == TIE_ROD)
            at += snprintf(text + at, room - (size_t)at, "link rod1 r%d s%d length=0.38\n", i, i);
        else
            at += snprintf(text + at, room - (size_t)at, "spherical j%d r%d s%d\n", tie, i, i);
    }
}

/* The load of the road comes at once: after 60 ms places, rates, the tie rod's force and the energy
 * agree, in three methods. */
static void a_corner_on_bushings_bounces(void)
{
    static const char *const methods[] = {"dop853", "radau", "bdf"};
    static const char *const members[] = {"x", "y", "z", "wx", "wy", "wz"};
    FreeBodies s = corner();
    char text[8000], line[80];
    double largest, energy;

    write(&s, text, sizeof text);
    energy = free_run(&s, 0.06, 6000, &largest);
    EXPECT(fabs(s.body[UPRIGHT].c.at[2] - 0.12) > 0.01);
    for (int m = 0; m < 3; m++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, text);
        (void)snprintf(line, sizeof line, "simulate 0.06 rtol=1e-10 atol=1e-12 method=%s\n",
                       methods[m]);
        EXPECT_DONE(&kit, line);
        for (int i = 0; i < 6 * BODIES; i++) {
            const FreeBody *body = &s.body[i / 6];

            (void)snprintf(line, sizeof line, "%s.%s", names[i / 6], members[i % 6]);
            EXPECT(is_near(line, kit_value(&kit, line),
                           i % 6 < 3 ? body->c.at[i % 6] : body->w.at[i % 6 - 3], 1e-8));
        }
        EXPECT(is_near("rod1.fn", kit_value(&kit, "rod1.fn"), s.tie[2].force, 1e-7));
        EXPECT(is_near("energy", kit_value(&kit, "energy.total"), energy, 1e-8));
        kit_free(&kit);
    }
}

int main(void)
{
    RUN(a_corner_on_bushings_bounces);
    return test_end();
}
