/* family_flexible_arms.c: arms of two flexible links in space, against Lagrange's equations of
 * their points, and what their sections carry, against Newton and Euler of what is beyond the cut
 *
 * Places, speeds and angular velocities follow from the field of theory 9 link by link, integrals
 * by Gauss's rule; momenta, their rates and the energies' slopes are differences. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"
#include "shapes.h"

#include <gsl/gsl_integration.h>
#include <gsl/gsl_linalg.h>

enum { LINKS = 2, SHAPES = 6, POINTS = 12, MOST = LINKS * (1 + SHAPES), INSTANTS = 3, CUTS = 4 };

/* a place along a link: shapes, their derivatives by x, and S of theory 9 */
typedef struct SectionFrame {
    double x, weight;
    Shape at[SHAPES];
    double S[SHAPES][SHAPES];
} SectionFrame;

/* hangs with a hinge on what is before it, off its end */
typedef struct Link {
    int basis, modes[FAMILIES_OF_SHAPES], count, first; /* first: the hinge's coordinate */
    int family[SHAPES], term[SHAPES];
    double L, rho, J[3], stiff[FAMILIES_OF_SHAPES], damping, load[3], axis[3], off[3];
    SectionFrame stations[POINTS], pushed, end;
    double push[3]; /* a force at a station, in ground axes */
} Link;

typedef struct Arm {
    Link links[LINKS];
    int count;
    double gravity[3], mass, inertia[3]; /* of what the end carries */
    gsl_integration_glfixed_table *rule;
} Arm;

typedef struct Motion {
    double q[MOST], rate[MOST];
} Motion;

/* --- vectors --- */

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void add_cross(double factor, const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] += factor * (a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
}

/* out += R v, or its transpose's */
static void add_turned(double R[3][3], bool back, const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i] += (back ? R[j][i] : R[i][j]) * v[j];
}

/* R becomes R exp(angle axis) */
static void turn(double R[3][3], const double axis[3], double angle)
{
    for (int i = 0; i < 3; i++) {
        double *row = R[i], once[3] = {0}, twice[3] = {0};

        add_cross(1, row, axis, once);
        add_cross(1, once, axis, twice);
        for (int j = 0; j < 3; j++)
            row[j] += sin(angle) * once[j] + (1 - cos(angle)) * twice[j];
    }
}

/* --- a link --- */

static bool bends(const Link *link, int i)
{
    return link->family[i] == 1 || link->family[i] == 2;
}

static Shape shape_at(const Link *link, int i, double x)
{
    const double L = link->L;
    const Shape own = shape(link->basis, bends(link, i), link->term[i], x / L);

    return (Shape){own.value, own.slope / L, own.curve / (L * L)};
}

static SectionFrame station_at(const Arm *arm, const Link *link, double x, double weight)
{
    SectionFrame out = {.x = x, .weight = weight};

    for (int i = 0; i < link->count; i++)
        out.at[i] = shape_at(link, i, x);
    for (int p = 0; p < POINTS; p++) {
        double place, part;

        (void)gsl_integration_glfixed_point(0, x, (size_t)p, &place, &part, arm->rule);
        for (int i = 0; i < link->count; i++)
            for (int j = 0; j < link->count; j++)
                if (bends(link, i) && link->family[i] == link->family[j])
                    out.S[i][j] +=
                        part * shape_at(link, i, place).slope * shape_at(link, j, place).slope;
    }
    return out;
}

static void stations_beyond(const Arm *arm, const Link *link, double x, SectionFrame out[POINTS])
{
    for (int p = 0; p < POINTS; p++) {
        double place, weight;

        (void)gsl_integration_glfixed_point(x, link->L, (size_t)p, &place, &weight, arm->rule);
        out[p] = station_at(arm, link, place, weight);
    }
}

/* a frame: r and v in ground axes, W in its own; of a section what theory 9 has of it, too */
typedef struct Frame {
    double r[3], v[3], R[3][3], W[3];
    double h[3]; /* angular momentum per length of a section, in ground axes */
    double spin; /* and twice its kinetic energy */
} Frame;

/* what turns with c, b, a has of angular momentum and energy: theory 9, J A and A^T */
static void find_spin(const Link *link, const Frame *root, const double angle[3],
                      const double turning[3], Frame *out)
{
    const double c = angle[0], b = angle[1], a = angle[2];
    const double A[3][3] = {{1 - (a * a + b * b) / 2, a, -b},
                            {-a + b * c, 1 - (a * a + c * c) / 2, c},
                            {b + a * c, -c + a * b, 1 - (b * b + c * c) / 2}};
    const double own[3] = {turning[0] - b * turning[2], turning[1] + c * turning[2],
                           turning[2] - c * turning[1]};
    double h[3] = {0};

    out->spin = 0;
    for (int i = 0; i < 3; i++) {
        const double w = dot(A[i], root->W) + own[i];

        out->spin += link->J[i] * w * w;
        for (int j = 0; j < 3; j++)
            h[j] += A[i][j] * link->J[i] * w;
    }
    memset(out->h, 0, sizeof out->h);
    add_turned((double(*)[3])root->R, false, h, out->h);
}

static Frame section(const Link *link, const Frame *root, const SectionFrame *at,
                     const Motion *motion)
{
    static const double x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
    const double *q = motion->q + link->first + 1, *rate = motion->rate + link->first + 1;
    double p[3] = {at->x}, moving[3] = {0}, angle[3] = {0}, turning[3] = {0};
    Frame out = *root;

    for (int i = 0; i < link->count; i++) {
        static const int turned[] = {-1, 2, 1, 0};
        const int family = link->family[i], k = turned[family];
        const double by =
            family == 1 ? at->at[i].slope : (family == 2 ? -at->at[i].slope : at->at[i].value);

        if (family < 3) {
            p[family] += q[i] * at->at[i].value;
            moving[family] += rate[i] * at->at[i].value;
        }
        if (k >= 0) {
            angle[k] += q[i] * by;
            turning[k] += rate[i] * by;
        }
        for (int j = 0; j < link->count; j++) {
            p[0] -= q[i] * at->S[i][j] * q[j] / 2;
            moving[0] -= q[i] * at->S[i][j] * rate[j];
        }
    }
    find_spin(link, root, angle, turning, &out);
    add_cross(1, root->W, p, moving);
    add_turned(out.R, false, p, out.r);
    add_turned(out.R, false, moving, out.v);
    turn(out.R, z, angle[2]);
    turn(out.R, y, angle[1]);
    turn(out.R, x, angle[0]);
    out.W[0] = turning[0] - turning[2] * sin(angle[1]);
    out.W[1] = turning[1] * cos(angle[0]) + turning[2] * cos(angle[1]) * sin(angle[0]);
    out.W[2] = -turning[1] * sin(angle[0]) + turning[2] * cos(angle[1]) * cos(angle[0]);
    /* and what the root turns, in axes of the section */
    double ground[3] = {0};

    add_turned((double(*)[3])root->R, false, root->W, ground);
    add_turned(out.R, true, ground, out.W);
    return out;
}

static Frame root_of(const Link *link, const Frame *tail, const Motion *motion)
{
    Frame out = *tail;
    double moving[3] = {0}, ground[3] = {0};

    add_cross(1, tail->W, link->off, moving);
    add_turned(out.R, false, link->off, out.r);
    add_turned(out.R, false, moving, out.v);
    add_turned(out.R, false, tail->W, ground);
    turn(out.R, link->axis, motion->q[link->first]);
    for (int k = 0; k < 3; k++)
        out.W[k] = link->axis[k] * motion->rate[link->first];
    add_turned(out.R, true, ground, out.W);
    return out;
}

static double stored_in(const Link *link, const double *q)
{
    double sum = 0;

    for (int p = 0; p < POINTS; p++) {
        const SectionFrame *at = &link->stations[p];
        double strain[FAMILIES_OF_SHAPES] = {0};

        for (int i = 0; i < link->count; i++)
            strain[link->family[i]] += q[i] * (bends(link, i) ? at->at[i].curve : at->at[i].slope);
        for (int f = 0; f < FAMILIES_OF_SHAPES; f++)
            sum += at->weight * link->stiff[f] * strain[f] * strain[f] / 2;
    }
    return sum;
}

/* --- the arm --- */

/* sums over what is beyond a place of a link: of the whole arm beyond its root */
typedef struct Sums {
    double kinetic, potential;                           /* of weight and loads */
    double momentum[3], turning[3], force[3], moment[3]; /* about the origin, in ground axes */
} Sums;

static void add_point(const Frame *at, double mass, const double load[3], const double gravity[3],
                      Sums *sums)
{
    double force[3];

    for (int k = 0; k < 3; k++) {
        force[k] = load[k] + mass * gravity[k];
        sums->force[k] += force[k];
        sums->momentum[k] += mass * at->v[k];
    }
    sums->kinetic += mass * dot(at->v, at->v) / 2;
    sums->potential -= dot(force, at->r);
    add_cross(mass, at->r, at->v, sums->turning);
    add_cross(1, at->r, force, sums->moment);
}

static void add_link(const Arm *arm, const Link *link, const Frame *root,
                     const SectionFrame stations[POINTS], const Motion *motion, Sums *sums)
{
    for (int p = 0; p < POINTS; p++) {
        const double weight = stations[p].weight;
        const Frame at = section(link, root, &stations[p], motion);
        double load[3];

        for (int k = 0; k < 3; k++) {
            load[k] = weight * link->load[k];
            sums->turning[k] += weight * at.h[k];
        }
        sums->kinetic += weight * at.spin / 2;
        add_point(&at, weight * link->rho, load, arm->gravity, sums);
    }
}

static void add_carried(const Arm *arm, const Frame *end, Sums *sums)
{
    double spin[3];

    for (int k = 0; k < 3; k++) {
        spin[k] = arm->inertia[k] * end->W[k];
        sums->kinetic += spin[k] * end->W[k] / 2;
    }
    add_turned((double(*)[3])end->R, false, spin, sums->turning);
    add_point(end, arm->mass, (double[3]){0}, arm->gravity, sums);
}

/* of what is beyond x of a link, whose stations from there on are told; *cut: the section there */
static Sums sums_beyond(const Arm *arm, const Motion *motion, int first, const SectionFrame *from,
                        const SectionFrame *stations, Frame *cut)
{
    Frame tail = {.R = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    Sums sums = {0};

    for (int k = 0; k < LINKS; k++) {
        const Link *link = &arm->links[k];
        const Frame root = root_of(link, &tail, motion);

        if (k >= first)
            add_link(arm, link, &root, k == first ? stations : link->stations, motion, &sums);
        if (k > first || (k == first && from->x <= link->pushed.x)) {
            const Frame pushed = section(link, &root, &link->pushed, motion);

            add_point(&pushed, 0, link->push, arm->gravity, &sums);
        }
        if (k == first)
            *cut = section(link, &root, from, motion);
        tail = section(link, &root, &link->end, motion);
    }
    add_carried(arm, &tail, &sums);
    return sums;
}

static Sums sums_of(const Arm *arm, const Motion *motion)
{
    const SectionFrame root = {0};
    Frame cut;

    return sums_beyond(arm, motion, 0, &root, arm->links[0].stations, &cut);
}

/* --- Lagrange's equations --- */

/* weights of a derivative at -2, -1, 1 and 2 steps */
static const double weights[] = {1.0 / 12, -2.0 / 3, 2.0 / 3, -1.0 / 12};
static const int steps[] = {-2, -1, 1, 2};

#define STEP 5e-5

static Motion moved(const Arm *arm, const Motion *motion, const double *second, double t)
{
    Motion out = *motion;

    for (int i = 0; i < arm->count; i++) {
        out.q[i] += t * (motion->rate[i] + t * second[i] / 2);
        out.rate[i] += t * second[i];
    }
    return out;
}

/* dT/d(rate i): T is a quadratic form in them */
static double momentum_of(const Arm *arm, const Motion *motion, int i)
{
    Motion up = *motion, down = *motion;

    up.rate[i]++;
    down.rate[i]--;
    return (sums_of(arm, &up).kinetic - sums_of(arm, &down).kinetic) / 2;
}

static double potential(const Arm *arm, const Motion *motion)
{
    double sum = sums_of(arm, motion).potential;

    for (int k = 0; k < LINKS; k++)
        sum += stored_in(&arm->links[k], motion->q + arm->links[k].first + 1);
    return sum;
}

/* what drives coordinate i where nothing is accelerated: the Lagrangian's slope less dp/dt, and
 * damping, which is the slope of what rates in place of shapes would store */
static double drive_of(const Arm *arm, const Motion *motion, int i)
{
    static const double none[MOST] = {0};
    double sum = 0;

    for (int s = 0; s < 4; s++) {
        const double w = weights[s] / STEP;
        Motion beside = *motion, along = moved(arm, motion, none, steps[s] * STEP);

        beside.q[i] += steps[s] * STEP;
        sum += w * (sums_of(arm, &beside).kinetic - potential(arm, &beside) -
                    momentum_of(arm, &along, i));
        beside.rate[i] += steps[s];
        for (int k = 0; k < LINKS; k++)
            sum -= weights[s] * arm->links[k].damping *
                   stored_in(&arm->links[k], beside.rate + arm->links[k].first + 1);
    }
    return sum;
}

static void accelerations(const Arm *arm, const Motion *motion, double *out)
{
    const int n = arm->count;
    double entries[MOST * MOST], right[MOST];
    gsl_matrix_view M = gsl_matrix_view_array(entries, (size_t)n, (size_t)n);
    gsl_vector_view b = gsl_vector_view_array(right, (size_t)n);
    gsl_vector_view x = gsl_vector_view_array(out, (size_t)n);

    for (int i = 0; i < n; i++) {
        Motion one = *motion;

        memset(one.rate, 0, sizeof one.rate);
        one.rate[i] = 1;
        for (int j = 0; j < n; j++)
            entries[i * n + j] = momentum_of(arm, &one, j);
        right[i] = drive_of(arm, motion, i);
    }
    (void)gsl_linalg_cholesky_decomp1(&M.matrix);
    (void)gsl_linalg_cholesky_solve(&M.matrix, &b.vector, &x.vector);
}

/* classical Runge-Kutta */
static void step(const Arm *arm, Motion *motion, double h)
{
    static const double ahead[] = {0, 0.5, 0.5, 1}, weight[] = {1, 2, 2, 1};
    double second[MOST] = {0}, rate[MOST] = {0};
    Motion sum = *motion;

    for (int stage = 0; stage < 4; stage++) {
        Motion at = *motion;

        for (int i = 0; i < arm->count; i++) {
            at.q[i] += ahead[stage] * h * rate[i];
            at.rate[i] += ahead[stage] * h * second[i];
        }
        memcpy(rate, at.rate, sizeof rate);
        accelerations(arm, &at, second);
        for (int i = 0; i < arm->count; i++) {
            sum.q[i] += weight[stage] * h * rate[i] / 6;
            sum.rate[i] += weight[stage] * h * second[i] / 6;
        }
    }
    *motion = sum;
}

/* --- sections --- */

/* force and moment on what is before a cut, in axes of the section: what loads the part beyond it,
 * less the rates of its momenta */
static void carried(const Arm *arm, const Motion *motion, const double *second, int k, double x,
                    double out[6])
{
    const Link *link = &arm->links[k];
    const SectionFrame from = station_at(arm, link, x, 0);
    SectionFrame stations[POINTS];
    Frame cut, other;
    Sums sums;
    double moment[3];

    stations_beyond(arm, link, x, stations);
    sums = sums_beyond(arm, motion, k, &from, stations, &cut);
    for (int s = 0; s < 4; s++) {
        const Motion along = moved(arm, motion, second, steps[s] * STEP);
        const Sums then = sums_beyond(arm, &along, k, &from, stations, &other);

        for (int i = 0; i < 3; i++) {
            sums.force[i] -= weights[s] / STEP * then.momentum[i];
            sums.moment[i] -= weights[s] / STEP * then.turning[i];
        }
    }
    memcpy(moment, sums.moment, sizeof moment);
    add_cross(-1, cut.r, sums.force, moment);
    memset(out, 0, 6 * sizeof *out);
    add_turned(cut.R, true, sums.force, out);
    add_turned(cut.R, true, moment, out + 3);
}

/* --- members --- */

static void draw_vector(Member *m, double most, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = member_between(m, -most, most);
}

static void draw_link(Member *m, Arm *arm, Link *link)
{
    double length;

    link->basis = member_one_of(m, 3);
    link->first = arm->count;
    link->modes[0] = member_one_of(m, 2);
    link->modes[1] = 1 + member_one_of(m, 2);
    link->modes[2] = 1 + member_one_of(m, 2);
    link->modes[3] = member_one_of(m, 2);
    for (int f = 0; f < FAMILIES_OF_SHAPES; f++)
        for (int k = 0; k < link->modes[f]; k++, link->count++) {
            link->family[link->count] = f;
            link->term[link->count] = k;
        }
    arm->count += 1 + link->count;
    link->L = member_between(m, 0.7, 1.5);
    link->rho = member_between(m, 1, 3);
    for (int k = 0; k < 3; k++)
        link->J[k] = member_between(m, 0.01, 0.05);
    for (int f = 0; f < FAMILIES_OF_SHAPES; f++)
        link->stiff[f] = (f == 0 ? 20 : 1) * member_between(m, 5, 20);
    link->damping = member_one_of(m, 2) == 0 ? 0 : member_between(m, 0, 0.01);
    draw_vector(m, 3, link->load);
    draw_vector(m, 3, link->push);
    draw_vector(m, 1, link->axis);
    length = sqrt(dot(link->axis, link->axis));
    for (int k = 0; k < 3; k++)
        link->axis[k] /= length;
    if (link != arm->links)
        draw_vector(m, 0.2, link->off);
    stations_beyond(arm, link, 0, link->stations);
    link->pushed = station_at(arm, link, link->L * member_between(m, 0.2, 0.9), 0);
    link->end = station_at(arm, link, link->L, 0);
}

static void draw_arm(Member *m, Arm *arm, Motion *motion)
{
    *arm = (Arm){.mass = member_between(m, 0.1, 1),
                 .rule = gsl_integration_glfixed_table_alloc(POINTS)};
    *motion = (Motion){{0}, {0}};
    draw_vector(m, 10, arm->gravity);
    arm->inertia[0] = member_between(m, 0.02, 0.03);
    arm->inertia[1] = member_between(m, 0.02, 0.03);
    arm->inertia[2] = member_between(m, 0.02, 0.03);
    for (int k = 0; k < LINKS; k++) {
        Link *link = &arm->links[k];

        draw_link(m, arm, link);
        motion->q[link->first] = member_between(m, -3, 3);
        motion->rate[link->first] = member_between(m, -3, 3);
        for (int i = 1; i <= link->count; i++) {
            motion->q[link->first + i] = member_between(m, -0.1, 0.1);
            motion->rate[link->first + i] = member_between(m, -0.5, 0.5);
        }
    }
}

static void write_link(const Link *link, int k, Script *script)
{
    static const char *const tails[] = {"ground", "hand1"};

    write_line(script,
               "beam b%d length=%.17g mass_per_length=%.17g inertia_per_length=[%.17g, %.17g, "
               "%.17g] EA=%.17g EIz=%.17g EIy=%.17g GJ=%.17g modes=[%d, %d, %d, %d] basis=%s "
               "damping=[0, %.17g] load=[%.17g, %.17g, %.17g]",
               k, link->L, link->rho, link->J[0], link->J[1], link->J[2], link->stiff[0],
               link->stiff[1], link->stiff[2], link->stiff[3], link->modes[0], link->modes[1],
               link->modes[2], link->modes[3], bases[link->basis], link->damping, link->load[0],
               link->load[1], link->load[2]);
    write_line(script,
               "arm end%d b%d at=%.17g\narm pushed%d b%d at=%.17g\n"
               "force F%d pushed%d [%.17g, %.17g, %.17g]\n"
               "revolute h%d %s b%d axis=[%.17g, %.17g, %.17g]",
               k, k, link->L, k, k, link->pushed.x, k, k, link->push[0], link->push[1],
               link->push[2], k, tails[k - 1], k, link->axis[0], link->axis[1], link->axis[2]);
}

/* the name of coordinate i of a link */
static const char *name_of(const Link *link, int k, int i, char name[32])
{
    if (i == 0)
        (void)snprintf(name, 32, "h%d", k);
    else
        (void)snprintf(name, 32, "b%d.%s%d", k, letters[link->family[i - 1]],
                       link->term[i - 1] + 1);
    return name;
}

static void write_arm(Member *m, const Arm *arm, const Motion *motion, Script *script)
{
    const double *g = arm->gravity, *J = arm->inertia, *off = arm->links[1].off;
    char name[32];

    script->length = 0;
    write_line(script, "gravity [%.17g, %.17g, %.17g]", g[0], g[1], g[2]);
    write_link(&arm->links[0], 1, script);
    write_line(script, "arm hand1 end1 [%.17g, %.17g, %.17g]", off[0], off[1], off[2]);
    write_link(&arm->links[1], 2, script);
    write_line(script, "body m mass=%.17g inertia=[%.17g, %.17g, %.17g]\nweld w end2 m", arm->mass,
               J[0], J[1], J[2]);
    write_line(script, member_one_of(m, 2) == 0 ? "tree joint" : "tree absolute");
    for (int k = 0; k < LINKS; k++)
        for (int i = 0; i <= arm->links[k].count; i++) {
            const int j = arm->links[k].first + i;

            (void)name_of(&arm->links[k], k + 1, i, name);
            write_line(script, "init %s = %.17g, %s' = %.17g", name, motion->q[j], name,
                       motion->rate[j]);
        }
}

/* a member drawn, written and run to the end; whether that could be done */
static bool begin(Member *m, Kit *kit, Arm *arm, Motion *motion, Script *script, const char *run)
{
    bool done;

    *kit = kit_new();
    draw_arm(m, arm, motion);
    write_arm(m, arm, motion, script);
    write_line(script, "%s", run);
    done = kit_do(kit, script->text) == CT_OK;
    if (!done)
        tell(m, "%s\n", kit->error.message);
    return done;
}

static Verdict finish(Member *m, Kit *kit, Arm *arm, const Script *script, bool agrees)
{
    if (!agrees || m->told)
        tell(m, "%s", script->text);
    kit_free(kit);
    gsl_integration_glfixed_table_free(arm->rule);
    return agrees ? AGREES : DISAGREES;
}

static Verdict accelerates(Member *m)
{
    static Script script;
    static Arm arm;
    Motion motion;
    Kit kit;
    double second[MOST], size = 1;
    bool agrees = begin(m, &kit, &arm, &motion, &script, "assemble");

    accelerations(&arm, &motion, second);
    for (int i = 0; i < arm.count; i++)
        size = fmax(size, fabs(second[i]));
    for (int k = 0; agrees && k < LINKS; k++)
        for (int i = 0; i <= arm.links[k].count; i++) {
            char name[32], ask[48];

            (void)snprintf(ask, sizeof ask, "%s'' at 0", name_of(&arm.links[k], k + 1, i, name));
            agrees =
                keeps(m, ask, fabs(kit_value(&kit, ask) - second[arm.links[k].first + i]) / size,
                      1e-8) &&
                agrees;
        }
    return finish(m, &kit, &arm, &script, agrees);
}

static Verdict moves(Member *m)
{
    static const char *const told[] = {"h1", "h2", "m.x", "m.y", "m.z", "m.vx"};
    static Script script;
    static Arm arm;
    const double time = 0.06;
    Motion motion;
    Kit kit;
    bool agrees = begin(m, &kit, &arm, &motion, &script, "simulate 0.06 rtol=1e-9 atol=1e-11");

    for (int k = 1; agrees && k <= INSTANTS; k++) {
        Frame end;

        for (int i = 0; i < 40; i++)
            step(&arm, &motion, time / INSTANTS / 40);
        (void)sums_beyond(&arm, &motion, 1, &arm.links[1].end, arm.links[1].stations, &end);
        const double wanted[] = {
            motion.q[0], motion.q[arm.links[1].first], end.r[0], end.r[1], end.r[2], end.v[0]};

        for (int i = 0; i < 6; i++) {
            char ask[48];

            (void)snprintf(ask, sizeof ask, "%s at %.17g", told[i], time * k / INSTANTS);
            agrees = keeps(m, ask, fabs(kit_value(&kit, ask) - wanted[i]), 1e-6) && agrees;
        }
    }
    return finish(m, &kit, &arm, &script, agrees);
}

static Verdict sections(Member *m)
{
    static const char *const told[] = {"axial",   "sheary",   "shearz",
                                       "torsion", "bendingy", "bendingz"};
    static Script script;
    static Arm arm;
    Motion motion;
    Kit kit;
    double second[MOST];
    bool agrees = begin(m, &kit, &arm, &motion, &script, "assemble");

    accelerations(&arm, &motion, second);
    for (int cut = 0; agrees && cut < CUTS; cut++) {
        const int k = cut % LINKS;
        const double x = cut < LINKS ? 0 : arm.links[k].L * member_between(m, 0, 1);
        double wanted[6], size = 1;

        carried(&arm, &motion, second, k, x, wanted);
        for (int i = 0; i < 6; i++)
            size = fmax(size, fabs(wanted[i]));
        for (int i = 0; i < 6; i++) {
            char ask[64];

            (void)snprintf(ask, sizeof ask, "b%d.%s(%.17g) at 0", k + 1, told[i], x);
            agrees = keeps(m, ask, fabs(kit_value(&kit, ask) - wanted[i]) / size, 1e-8) && agrees;
        }
    }
    return finish(m, &kit, &arm, &script, agrees);
}

static const Family families[] = {
    {"an arm of two flexible links in space accelerates by Lagrange's equations", 3, 0, 0,
     accelerates},
    {"it moves by them, too", 1, 0, 0, moves},
    {"its sections carry what is beyond the cut", 3, 0, 0, sections},
};

int main(int argc, char **argv)
{
    return family_main(families, (int)(sizeof families / sizeof *families), argc, argv);
}
