/* family_bushings.c: bodies on bushings of any stiffness and damping, with rods, ball joints and
 * constant-velocity couplings between them, in any tree, against Newton and Euler in absolute
 * coordinates (free_bodies.h) */
#include "../unit/session_kit.h"
#include "base/text.h"
#include "family.h"
#include "free_bodies.h"

static Spot draw_spot(Member *member, int body)
{
    Spot spot = {.body = body};

    for (int i = 0; i < 3; i++)
        spot.at.at[i] = member_between(member, -0.3, 0.3);
    for (int i = 0; i < 2; i++)
        spot.turn[i] = member_between(member, -1, 1);
    return spot;
}

/* A^T A of a random A whose columns have that size: full, or its diagonal alone */
static void draw_matrix(Member *member, bool is_full, double along, double about, double m[6][6])
{
    double a[6][6];

    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            a[i][j] = member_between(member, -1, 1) * sqrt(j < 3 ? along : about);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            m[i][j] = 0;
            for (int k = 0; k < 6 && (is_full || i == j); k++)
                m[i][j] += a[k][i] * a[k][j];
        }
    /* products round in their own order */
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < i; j++)
            m[i][j] = m[j][i];
}

static void draw_body(Member *member, FreeBody *body)
{
    double size = 0;

    body->mass = member_between(member, 0.5, 3);
    for (int i = 0; i < 3; i++) {
        body->inertia[i] = member_between(member, 0.1, 0.19);
        body->c.at[i] = member_between(member, -0.4, 0.4);
        body->v.at[i] = member_between(member, -1, 1);
        body->w.at[i] = member_between(member, -1, 1);
    }
    for (int i = 0; i < 4; i++) {
        body->q[i] = i == 0 ? 1 : member_between(member, -0.4, 0.4);
        size += body->q[i] * body->q[i];
    }
    for (int i = 0; i < 4; i++)
        body->q[i] /= sqrt(size);
}

/* A rod whose ends come neither nearer nor farther at the start: the second body gets the velocity
 * for that. It is the last to be drawn of its body. */
static void draw_rod(Member *member, FreeBodies *s, int from, int to)
{
    Tie *rod = &s->tie[s->ties++];
    SpotMotion tail, tip;
    V apart, v;

    *rod = (Tie){.tail = draw_spot(member, from), .tip = draw_spot(member, to), .kind = TIE_ROD};
    tail = spot_motion(s, &rod->tail);
    tip = spot_motion(s, &rod->tip);
    apart = plus(tip.r, -1, tail.r);
    v = plus(tip.v, -1, tail.v);
    rod->length = sqrt(dot(apart, apart));
    s->body[to].v = plus(s->body[to].v, -dot(v, apart) / (rod->length * rod->length), apart);
}

/* a body that begins on a ball of another */
static void draw_ball(Member *member, FreeBodies *s, int from, int to)
{
    Tie *ball = &s->tie[s->ties++];
    SpotMotion tail, tip;

    *ball = (Tie){.tail = draw_spot(member, from), .tip = draw_spot(member, to)};
    tail = spot_motion(s, &ball->tail);
    tip = spot_motion(s, &ball->tip);
    s->body[to].c = plus(s->body[to].c, 1, plus(tail.r, -1, tip.r));
    s->body[to].v = plus(s->body[to].v, 1, plus(tail.v, -1, tip.v));
}

/* Shafts along z of both bodies, the second bent against the first without a spin; its angular
 * velocity is corrected to that. */
static void draw_coupling(Member *member, FreeBodies *s, int from, int to)
{
    const double bend = member_between(member, 0, 0.4), across = member_between(member, 0, 6);
    const V z = {{0, 0, 1}}, lean = {{cos(across), sin(across), 0}};
    const FreeBody *first = &s->body[from];
    FreeBody *second = &s->body[to];
    const M turn_first = matrix_of(first->q);
    M turn_second;
    V bisector;

    turn(first->q, plus(zero_vector(), 2 * bend, apply(&turn_first, lean)), second->q);
    turn_second = matrix_of(second->q);
    bisector = plus(apply(&turn_first, z), 1, apply(&turn_second, z));
    second->w =
        plus(second->w, -dot(plus(second->w, -1, first->w), bisector) / dot(bisector, bisector),
             bisector);
    s->tie[s->ties++] = (Tie){.tail = {.body = from}, .tip = {.body = to}, .kind = TIE_SPIN};
}

static void draw(Member *member, FreeBodies *s)
{
    *s = (FreeBodies){.count = 1 + (member_one_of(member, 8) + 2) / 4};
    for (int i = 0; i < 3; i++)
        s->gravity.at[i] = member_between(member, -3, 3);
    for (int i = 0; i < s->count; i++) {
        const bool is_full = member_one_of(member, 2) == 0, damps = member_one_of(member, 2) == 0;
        const int from = i - 1 - (i > 0 ? member_one_of(member, i + 1) : 0);
        Bush *bush = &s->bush[s->bushes++];

        draw_body(member, &s->body[i]);
        *bush = (Bush){.tail = draw_spot(member, from), .tip = draw_spot(member, i)};
        draw_matrix(member, is_full, 20, 5, bush->k);
        draw_matrix(member, is_full, damps ? 1 : 0, damps ? 0.3 : 0, bush->d);
        if (i > 0 && member_one_of(member, 3) == 0)
            draw_coupling(member, s, i - 1, i);
        if (i > 0 && member_one_of(member, 3) == 0)
            draw_ball(member, s, i - 1, i);
        else if (i > 0 && member_one_of(member, 2) == 0)
            draw_rod(member, s, i - 1, i);
    }
}

/* --- the same in cotree --- */

static void write_spot(const Spot *spot, const char *kind, int number, Text *out)
{
    char body[16] = "ground";

    if (spot->body != GROUND)
        (void)snprintf(body, sizeof body, "b%d", spot->body);
    text_addf(out, "arm %s%d %s [%.17g, %.17g, %.17g] rotation=x(%.17g)*y(%.17g)\n", kind, number,
              body, spot->at.at[0], spot->at.at[1], spot->at.at[2], spot->turn[0], spot->turn[1]);
}

/* the diagonal alone where the rest is 0 */
static void write_matrix(const char *key, const double m[6][6], Text *out)
{
    bool is_full = false;

    for (int i = 0; i < 6; i++)
        for (int j = 0; j < i; j++)
            is_full = is_full || m[i][j] != 0;
    text_addf(out, " %s=[", key);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            if (is_full || i == j)
                text_addf(out, "%s%.17g", i + j > 0 ? ", " : "", m[i][j]);
    text_add(out, "]");
}

static void write(Member *member, const FreeBodies *s, Text *out)
{
    text_addf(out, "gravity [%.17g, %.17g, %.17g]\n", s->gravity.at[0], s->gravity.at[1],
              s->gravity.at[2]);
    for (int i = 0; i < s->count; i++)
        text_addf(out, "body b%d mass=%.17g inertia=[%.17g, %.17g, %.17g]\n", i, s->body[i].mass,
                  s->body[i].inertia[0], s->body[i].inertia[1], s->body[i].inertia[2]);
    for (int i = 0; i < s->bushes; i++) {
        write_spot(&s->bush[i].tail, "r", i, out);
        write_spot(&s->bush[i].tip, "s", i, out);
        text_addf(out, "bushing k%d r%d s%d", i, i, i);
        write_matrix("k", s->bush[i].k, out);
        write_matrix("d", s->bush[i].d, out);
        text_add(out, "\n");
    }
    for (int i = 0; i < s->ties; i++) {
        const Tie *tie = &s->tie[i];

        write_spot(&tie->tail, "e", i, out);
        write_spot(&tie->tip, "f", i, out);
        if (tie->kind == TIE_SPIN)
            text_addf(out, "constvel t%d e%d f%d\n", i, i, i);
        else if (tie->kind == TIE_ROD)
            text_addf(out, "link t%d e%d f%d %.17g\n", i, i, i, tie->length);
        else
            text_addf(out, "spherical t%d e%d f%d\n", i, i, i);
    }
    /* a tree statement counts the operations of all entries, which takes seconds with rods */
    switch (member_one_of(member, s->ties > 0 ? 10 : 3)) {
    case 0:
        text_add(out, "tree joint\n");
        break;
    case 1: /* across the first bushing */
        text_add(out, "virtual free v r0 s0\ntree v\n");
        break;
    case 2:
        text_add(out, "tree absolute\n");
        break;
    default:
        break;
    }
    if (s->ties > 0 && member_one_of(member, 3) == 0)
        text_add(out, "form embedded\n");
    for (int i = 0; i < s->count; i++) {
        const FreeBody *b = &s->body[i];

        text_addf(out, "init b%d.x = %.17g, b%d.y = %.17g, b%d.z = %.17g\n", i, b->c.at[0], i,
                  b->c.at[1], i, b->c.at[2]);
        text_addf(out, "init b%d.q1 = %.17g, b%d.q2 = %.17g, b%d.q3 = %.17g\n", i, b->q[1], i,
                  b->q[2], i, b->q[3]);
        text_addf(out, "init b%d.vx = %.17g, b%d.vy = %.17g, b%d.vz = %.17g\n", i, b->v.at[0], i,
                  b->v.at[1], i, b->v.at[2]);
        text_addf(out, "init b%d.wx = %.17g, b%d.wy = %.17g, b%d.wz = %.17g\n", i, b->w.at[0], i,
                  b->w.at[1], i, b->w.at[2]);
    }
}

static bool is_near(Member *member, Kit *kit, const char *name, double wanted, double bound)
{
    return keeps(member, name, fabs(kit_value(kit, name) - wanted), bound * (1 + fabs(wanted)));
}

/* places and angular velocities of all bodies, forces of rods, and the energy */
static bool agrees(Member *member, Kit *kit, const FreeBodies *s, double energy, double bound)
{
    static const char *const members[] = {"x", "y", "z", "wx", "wy", "wz"};
    bool near = true;
    char name[32];

    for (int i = 0; i < 6 * s->count; i++) {
        const FreeBody *body = &s->body[i / 6];

        (void)snprintf(name, sizeof name, "b%d.%s", i / 6, members[i % 6]);
        near = is_near(member, kit, name, i % 6 < 3 ? body->c.at[i % 6] : body->w.at[i % 6 - 3],
                       bound) &&
               near;
    }
    for (int i = 0; i < s->ties; i++) {
        (void)snprintf(name, sizeof name, "t%d.fn", i);
        near = (s->tie[i].kind != TIE_ROD ||
                is_near(member, kit, name, s->tie[i].force, 10 * bound)) &&
               near;
    }
    return is_near(member, kit, "energy.total", energy, 10 * bound) && near;
}

static Verdict bodies_hang_on_bushings(Member *member)
{
    static const char *const methods[] = {"auto", "dop853", "radau", "bdf"};
    enum { STEPS = 800 };
    FreeBodies s, coarse, fine;
    Text text = {0};
    Kit kit = kit_new();
    Verdict verdict = AGREES;
    double end, energy, largest, off = 0;

    draw(member, &s);
    end = member_between(member, 0.3, 1.2);
    coarse = fine = s;
    (void)free_run(&coarse, end, STEPS / 2, &largest);
    energy = free_run(&fine, end, STEPS, &largest);
    for (int i = 0; i < s.count; i++)
        for (int k = 0; k < 3; k++)
            off = fmax(off, fmax(fabs(coarse.body[i].c.at[k] - fine.body[i].c.at[k]),
                                 fabs(coarse.body[i].w.at[k] - fine.body[i].w.at[k])));
    write(member, &s, &text);
    text_addf(&text, "simulate %.17g rtol=1e-10 atol=1e-12 method=%s\n", end,
              methods[member_one_of(member, 4)]);
    tell(member, "%s", text.at);
    if (largest > 3 || !(off < 1e-5)) /* near half a turn, or the oracle's steps are too long */
        verdict = REFUSED;
    else if (kit_do(&kit, text.at) != CT_OK) {
        tell(member, "refused: %s\n", kit.error.message);
        verdict = DISAGREES;
    } else if (!agrees(member, &kit, &fine, energy, 1e-7 + off)) {
        verdict = DISAGREES;
    }
    text_free(&text);
    kit_free(&kit);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"bodies_hang_on_bushings", 24, 0.4, 0, bodies_hang_on_bushings}};

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
