/* family_beam_machines.c: machines with a beam in a loop against equations of another kind
 *
 * Each part has coordinates of its own in the plane, joints are rows with multipliers, and a beam
 * is a sum over Gauss's points of mass points, whose places and their derivatives follow from the
 * field of theory 9. Classical Runge-Kutta of short fixed steps. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

enum { POINTS = 12, MOST = 16, ROWS = 7, PARTS = 3, SHAPES = 3, INSTANTS = 4, TOLD = 4 };

#define STEP 5e-6 /* s */

typedef enum Machine { SWINGS, SLIDES, ROCKS } Machine;

/* a rigid part (shapes 0) or a beam: x, y, angle, then shapes of bending, taylor's */
typedef struct Part {
    int first, shapes;
    double mass, inertia;    /* of the rigid */
    double L, rho, spin, EI; /* of the beam */
} Part;

/* the place of a part at (x, 0) or at x along it is that of another, or of ground */
typedef struct Pin {
    int part, other; /* -1: ground */
    double at, other_at, place[2];
} Pin;

typedef struct Scene {
    Machine machine;
    double crank, rod, rocker, base, angle, rate, EI, rho, spin, mass;
    double knee, bend; /* angles of the rocker, and of the rod on the crank, that close the loop */
    double bent;       /* v1 of the rod at the start, m: its end is at once that far aside */
    int shapes;
    Part parts[PARTS];
    Pin pins[ROWS];
    int part_count, pin_count, count, slider; /* the part that stays on the x axis; -1 */
} Scene;

/* --- points of parts --- */

/* where (x, y) of a part is, how its coordinates move it, and its acceleration at theirs of 0 */
typedef struct Place {
    double r[2], move[2][MOST], bias[2];
} Place;

static Place place_of(const Part *part, const double *q, const double *rate, double x)
{
    const double c = cos(q[part->first + 2]), s = sin(q[part->first + 2]);
    const double w = rate[part->first + 2];
    const double *bend = q + part->first + 3, *bending = rate + part->first + 3;
    double p[2] = {x, 0}, move[SHAPES][2], going[2] = {0}, left = 0;
    Place out = {{0}, {{0}}, {0}};

    for (int i = 0; i < part->shapes; i++) {
        const double xi = x / part->L;

        move[i][0] = 0;
        move[i][1] = pow(xi, i + 2);
        for (int j = 0; j < part->shapes; j++) { /* int N_i' N_j' of powers */
            const double S = (i + 2) * (j + 2) * pow(xi, i + j + 3) / (i + j + 3) / part->L;

            move[i][0] -= S * bend[j];
            left -= S * bending[i] * bending[j];
        }
        p[0] += move[i][0] * bend[i] / 2;
        p[1] += move[i][1] * bend[i];
        going[0] += move[i][0] * bending[i];
        going[1] += move[i][1] * bending[i];
    }
    const double bias[2] = {-w * w * p[0] - 2 * w * going[1] + left,
                            -w * w * p[1] + 2 * w * going[0]};

    out.r[0] = q[part->first] + c * p[0] - s * p[1];
    out.r[1] = q[part->first + 1] + s * p[0] + c * p[1];
    out.bias[0] = c * bias[0] - s * bias[1];
    out.bias[1] = s * bias[0] + c * bias[1];
    out.move[0][part->first] = out.move[1][part->first + 1] = 1;
    out.move[0][part->first + 2] = -s * p[0] - c * p[1];
    out.move[1][part->first + 2] = c * p[0] - s * p[1];
    for (int i = 0; i < part->shapes; i++) {
        out.move[0][part->first + 3 + i] = c * move[i][0] - s * move[i][1];
        out.move[1][part->first + 3 + i] = s * move[i][0] + c * move[i][1];
    }
    return out;
}

/* --- equations --- */

typedef struct Rule { /* Gauss's points over 0..1 */
    double at[POINTS], weight[POINTS];
} Rule;

static Rule rule_of(void)
{
    Rule rule;

    for (int i = 0; i < POINTS; i++) {
        double z = cos(acos(-1) * (i + 0.75) / (POINTS + 0.5)), slope = 1;

        for (int round = 0; round < 8; round++) {
            double before = 1, now = z;

            for (int n = 1; n < POINTS; n++) {
                const double next = ((2 * n + 1) * z * now - n * before) / (n + 1);

                before = now;
                now = next;
            }
            slope = POINTS * (z * now - before) / (z * z - 1);
            z -= now / slope;
        }
        rule.at[i] = (1 + z) / 2;
        rule.weight[i] = 1 / ((1 - z * z) * slope * slope);
    }
    return rule;
}

typedef struct Equations {
    double at[MOST + 2 * ROWS][MOST + 2 * ROWS + 1]; /* M, rows of joints, and the right side */
    int size;
} Equations;

/* a point of mass m under gravity */
static void add_point(Equations *e, int count, const Place *place, double m)
{
    for (int i = 0; i < count; i++) {
        e->at[i][e->size] -=
            m * (place->move[0][i] * place->bias[0] + place->move[1][i] * (place->bias[1] + 9.81));
        for (int j = 0; j < count; j++)
            e->at[i][j] +=
                m * (place->move[0][i] * place->move[0][j] + place->move[1][i] * place->move[1][j]);
    }
}

static void add_beam(Equations *e, int count, const Part *part, const Rule *rule, const double *q,
                     const double *rate)
{
    for (int k = 0; k < POINTS; k++) {
        const double xi = rule->at[k], weight = rule->weight[k] * part->L;
        const Place place = place_of(part, q, rate, xi * part->L);
        double turn[MOST] = {0}, curve[SHAPES] = {0}, curvature = 0;

        turn[part->first + 2] = 1;
        for (int i = 0; i < part->shapes; i++) {
            turn[part->first + 3 + i] = (i + 2) * pow(xi, i + 1) / part->L;
            curve[i] = (i + 2) * (i + 1) * pow(xi, i) / (part->L * part->L);
            curvature += curve[i] * q[part->first + 3 + i];
        }
        add_point(e, count, &place, weight * part->rho);
        for (int i = 0; i < count; i++)
            for (int j = 0; j < count; j++)
                e->at[i][j] += weight * part->spin * turn[i] * turn[j];
        for (int i = 0; i < part->shapes; i++)
            e->at[part->first + 3 + i][e->size] -= weight * part->EI * curve[i] * curvature;
    }
}

static void add_row(Equations *e, int row, const double *move, double bias, int count)
{
    for (int i = 0; i < count; i++)
        e->at[row][i] = e->at[i][row] = move[i];
    e->at[row][e->size] = -bias;
}

static void add_pin(Equations *e, int row, const Scene *scene, const Pin *pin, const double *q,
                    const double *rate)
{
    const Place one = place_of(&scene->parts[pin->part], q, rate, pin->at);
    Place other = {{0}, {{0}}, {0}};

    if (pin->other >= 0)
        other = place_of(&scene->parts[pin->other], q, rate, pin->other_at);
    for (int k = 0; k < 2; k++) {
        double move[MOST];

        for (int i = 0; i < MOST; i++)
            move[i] = one.move[k][i] - other.move[k][i];
        add_row(e, row + k, move, one.bias[k] - other.bias[k], scene->count);
    }
}

/* by elimination with pivots; the solution into the last column */
static void solve(Equations *e)
{
    const int n = e->size;

    for (int c = 0; c < n; c++) {
        int best = c;

        for (int r = c + 1; r < n; r++)
            best = fabs(e->at[r][c]) > fabs(e->at[best][c]) ? r : best;
        for (int k = c; k <= n; k++) {
            const double held = e->at[c][k];

            e->at[c][k] = e->at[best][k];
            e->at[best][k] = held;
        }
        for (int r = 0; r < n; r++) {
            const double factor = r == c ? 0 : e->at[r][c] / e->at[c][c];

            for (int k = c; k <= n && factor != 0; k++)
                e->at[r][k] -= factor * e->at[c][k];
        }
    }
    for (int r = 0; r < n; r++)
        e->at[r][n] /= e->at[r][r];
}

static void accelerations(const Scene *scene, const Rule *rule, const double *q, const double *rate,
                          double *out)
{
    static Equations e;
    int row = scene->count;

    memset(&e, 0, sizeof e);
    e.size = scene->count + 2 * scene->pin_count + (scene->slider >= 0 ? 2 : 0);
    for (int k = 0; k < scene->part_count; k++) {
        const Part *part = &scene->parts[k];
        const Place centre = place_of(part, q, rate, 0);

        if (part->shapes > 0) {
            add_beam(&e, scene->count, part, rule, q, rate);
            continue;
        }
        add_point(&e, scene->count, &centre, part->mass);
        e.at[part->first + 2][part->first + 2] += part->inertia;
    }
    for (int k = 0; k < scene->pin_count; k++, row += 2)
        add_pin(&e, row, scene, &scene->pins[k], q, rate);
    for (int k = 1; k < 3 && scene->slider >= 0; k++, row++) { /* its y and its angle stay */
        double move[MOST] = {0};

        move[scene->parts[scene->slider].first + k] = 1;
        add_row(&e, row, move, 0, scene->count);
    }
    solve(&e);
    for (int i = 0; i < scene->count; i++)
        out[i] = e.at[i][e.size];
}

static void step(const Scene *scene, const Rule *rule, double *y, double h)
{
    static const double ahead[] = {0, 0.5, 0.5, 1}, weight[] = {1, 2, 2, 1};
    const int n = scene->count;
    double rate[2 * MOST] = {0}, at[2 * MOST] = {0}, sum[2 * MOST] = {0};

    for (int stage = 0; stage < 4; stage++) {
        for (int i = 0; i < 2 * n; i++)
            at[i] = y[i] + ahead[stage] * h * rate[i];
        memcpy(rate, at + n, (size_t)n * sizeof *rate);
        accelerations(scene, rule, at, at + n, rate + n);
        for (int i = 0; i < 2 * n; i++)
            sum[i] += weight[stage] * rate[i] / 6;
    }
    for (int i = 0; i < 2 * n; i++)
        y[i] += h * sum[i];
}

/* --- scenes --- */

static int add_part(Scene *scene, Part part)
{
    part.first = scene->count;
    scene->count += 3 + part.shapes;
    scene->parts[scene->part_count] = part;
    return scene->part_count++;
}

static int beam_of(Scene *scene)
{
    return add_part(scene, (Part){.shapes = scene->shapes,
                                  .L = scene->rod,
                                  .rho = scene->rho,
                                  .spin = scene->spin,
                                  .EI = scene->EI});
}

/* a part at rest but for its place: (x, y), its angle, and their rates */
static void begin(const Scene *scene, int part, const double place[3], const double rate[3],
                  double *y)
{
    for (int k = 0; k < 3; k++) {
        y[scene->parts[part].first + k] = place[k];
        y[scene->count + scene->parts[part].first + k] = rate[k];
    }
}

/* the crank, and the rod as a rigid one stands and turns; rod: its angle and rate */
static void begin_rod(const Scene *scene, int crank, int rod, const double turn[2], double *y)
{
    const double c = scene->crank * cos(scene->angle), s = scene->crank * sin(scene->angle);

    begin(scene, crank, (double[]){0, 0, scene->angle}, (double[]){0, 0, scene->rate}, y);
    begin(scene, rod, (double[]){c, s, turn[0]},
          (double[]){-s * scene->rate, c * scene->rate, turn[1]}, y);
}

static void build_slider_crank(Scene *scene, double *y)
{
    const int crank = add_part(scene, (Part){.mass = 1, .inertia = 1e-3});
    const int rod = beam_of(scene);
    const double height = scene->crank * sin(scene->angle),
                 width = scene->crank * cos(scene->angle);
    /* the end of the bent rod, along its root */
    const double along = scene->rod - 2 * scene->bent * scene->bent / (3 * scene->rod);
    const double length = hypot(along, scene->bent);
    const double psi = -asin(height / length) - atan2(scene->bent, along);
    const double reach = sqrt(length * length - height * height);
    const double turn[2] = {psi, -width * scene->rate / reach};

    scene->slider = add_part(scene, (Part){.mass = scene->mass, .inertia = 1e-3});
    scene->pins[scene->pin_count++] = (Pin){.part = crank, .other = -1};
    scene->pins[scene->pin_count++] = (Pin){.part = rod, .other = crank, .other_at = scene->crank};
    scene->pins[scene->pin_count++] =
        (Pin){.part = scene->slider, .other = rod, .other_at = scene->rod};
    begin_rod(scene, crank, rod, turn, y);
    y[scene->parts[rod].first + 3] = scene->bent;
    begin(scene, scene->slider, (double[]){width + reach, 0, 0},
          (double[]){-height * scene->rate + height * turn[1], 0, 0}, y);
}

/* where the coupler and the rocker stand: beyond the line from the crank's pin to the base */
static void build_four_bar(Scene *scene, double *y)
{
    const int crank = add_part(scene, (Part){.mass = 1, .inertia = 1e-3});
    const int rod = beam_of(scene);
    const int rocker = add_part(scene, (Part){.mass = scene->mass, .inertia = 0.02});
    const double dx = scene->base - scene->crank * cos(scene->angle),
                 dy = -scene->crank * sin(scene->angle), d = hypot(dx, dy);
    const double bend = acos((d * d + scene->rod * scene->rod - scene->rocker * scene->rocker) /
                             (2 * d * scene->rod));
    const double psi = atan2(dy, dx) + bend;
    const double ex = scene->rod * cos(psi) - dx, ey = scene->rod * sin(psi) - dy;
    const double chi = atan2(ey, ex);
    /* the pin's speed and the turns of both along the coupler and the rocker */
    const double along = -scene->crank * scene->rate * sin(scene->angle),
                 up = scene->crank * scene->rate * cos(scene->angle);
    const double turn[2] = {psi,
                            -(along * cos(chi) + up * sin(chi)) / (scene->rod * sin(chi - psi))};
    const double swing = -(along * cos(psi) + up * sin(psi)) / (scene->rocker * sin(chi - psi));

    scene->slider = -1;
    scene->knee = chi;
    scene->bend = psi - scene->angle;
    scene->pins[scene->pin_count++] = (Pin){.part = crank, .other = -1};
    scene->pins[scene->pin_count++] = (Pin){.part = rod, .other = crank, .other_at = scene->crank};
    scene->pins[scene->pin_count++] = (Pin){.part = rocker, .other = -1};
    scene->pins[scene->pin_count++] =
        (Pin){.part = rocker, .at = scene->rocker, .other = rod, .other_at = scene->rod};
    begin_rod(scene, crank, rod, turn, y);
    begin(scene, rocker, (double[]){scene->base, 0, chi}, (double[]){0, 0, swing}, y);
}

static void build_pendulum(Scene *scene, double *y)
{
    const int rod = beam_of(scene);

    scene->slider = -1;
    scene->pins[scene->pin_count++] = (Pin){.part = rod, .other = -1};
    begin(scene, rod, (double[]){0, 0, scene->angle}, (double[]){0, 0, scene->rate}, y);
}

static void write_scene(const Scene *scene, int way, double time, Script *script)
{
    static const char *const bases[] = {"taylor", "legendre", "chebyshev"};

    script->length = 0;
    write_line(script, "scene planar\ngravity [0, -9.81]");
    write_line(
        script,
        "L = %.17g\nbeam rod length=L mass_per_length=%.17g inertia_per_length=%.17g EIz=%.17g "
        "modes=[0, %d] basis=%s\narm end rod at=L",
        scene->rod, scene->rho, scene->spin, scene->EI, scene->shapes, bases[way]);
    if (scene->machine == SWINGS)
        write_line(script, "revolute h1 ground rod");
    else
        write_line(script,
                   "body crank mass=1 inertia=1e-3\narm pin crank [%.17g, 0]\n"
                   "revolute h1 ground crank\nrevolute h2 pin rod",
                   scene->crank);
    if (scene->machine == SLIDES)
        write_line(script,
                   "body slider mass=%.17g inertia=1e-3\nrevolute h3 end slider\n"
                   "prismatic s ground slider axis=x\nguess s = %.17g\ninit rod.v1 = %.17g",
                   scene->mass, scene->rod, way == 1 ? 2 * scene->bent : scene->bent);
    if (scene->machine == ROCKS)
        write_line(script,
                   "body rocker mass=%.17g inertia=0.02\narm knee rocker [%.17g, 0]\n"
                   "arm base ground [%.17g, 0]\nrevolute h4 base rocker\nrevolute h3 end knee\n"
                   "guess h4 = %.17g, h2 = %.17g",
                   scene->mass, scene->rocker, scene->base, scene->knee, scene->bend);
    if (way > 0)
        write_line(script, way == 1 ? "tree joint" : "tree absolute");
    write_line(script, "init h1 = %.17g, h1' = %.17g", scene->angle, scene->rate);
    write_line(script, "simulate %.17g every=%.17g rtol=1e-9 atol=1e-11", time, time / INSTANTS);
}

static Verdict machine(Member *m, Machine kind)
{
    static Script script;
    const Rule rule = rule_of();
    const double time = 0.03;
    Scene scene = {.machine = kind};
    double y[2 * MOST] = {0}, wanted[INSTANTS][TOLD], size[TOLD] = {0.01, 0.01, 0.01, 0.01};
    bool agrees = true;

    scene.crank = member_between(m, 0.08, 0.12);
    scene.rod = member_between(m, 0.35, 0.5);
    scene.rocker = member_between(m, 0.25, 0.32);
    scene.base = member_between(m, 0.38, 0.42);
    scene.angle = member_between(m, -3, 3);
    scene.rate = member_between(m, -30, 30);
    scene.EI = member_between(m, 2, 20);
    scene.rho = member_between(m, 0.3, 1);
    scene.spin = member_between(m, 0, 1e-4);
    scene.mass = member_between(m, 0.2, 1);
    scene.bent = member_between(m, -0.08, 0.08);
    scene.shapes = 1 + (int)(test_random(&m->random) % SHAPES);
    (kind == SWINGS   ? build_pendulum
     : kind == SLIDES ? build_slider_crank
                      : build_four_bar)(&scene, y);
    for (int k = 0; k < INSTANTS; k++) {
        const int steps = (int)(time / INSTANTS / STEP + 0.5);
        const int rod = kind == SWINGS ? 0 : 1;
        Place end;

        for (int i = 0; i < steps; i++)
            step(&scene, &rule, y, time / INSTANTS / steps);
        end = place_of(&scene.parts[rod], y, y + scene.count, scene.rod);
        wanted[k][0] = end.r[0];
        wanted[k][1] = end.r[1];
        wanted[k][2] = y[scene.parts[0].first + 2];
        wanted[k][3] = 0;
        for (int i = 0; i < scene.shapes; i++)
            wanted[k][3] += y[scene.parts[rod].first + 3 + i];
        for (int i = 0; i < TOLD; i++)
            size[i] = fmax(size[i], fabs(wanted[k][i]));
    }
    for (int way = 0; way < 3; way++) {
        Kit kit = kit_new();

        write_scene(&scene, way, time, &script);
        if (kit_do(&kit, script.text) != CT_OK) {
            tell(m, "%s\n", kit.error.message);
            agrees = false;
        }
        for (int k = 0; k < INSTANTS; k++)
            for (int i = 0; i < TOLD; i++) {
                static const char *const told[TOLD] = {"end.x", "end.y", "h1", "rod.v(L)"};
                char ask[64];

                (void)snprintf(ask, sizeof ask, "%s at %.17g", told[i], time * (k + 1) / INSTANTS);
                agrees =
                    keeps(m, told[i], fabs(kit_value(&kit, ask) - wanted[k][i]) / size[i], 1e-6) &&
                    agrees;
            }
        kit_free(&kit);
        if (!agrees)
            break;
    }
    if (!agrees || m->told)
        tell(m, "%s", script.text);
    return agrees ? AGREES : DISAGREES;
}

static Verdict pendulum(Member *m)
{
    return machine(m, SWINGS);
}

static Verdict slider_crank(Member *m)
{
    return machine(m, SLIDES);
}

static Verdict four_bar(Member *m)
{
    return machine(m, ROCKS);
}

static const Family families[] = {
    {"a pendulum that bends moves as its points do", 3, 0, 0, pendulum},
    {"a slider-crank's rod that bends does, in any tree and basis", 3, 0, 0, slider_crank},
    {"a four-bar's coupler that bends does, in any tree and basis", 3, 0, 0, four_bar},
};

int main(int argc, char **argv)
{
    return family_main(families, (int)(sizeof families / sizeof *families), argc, argv);
}
