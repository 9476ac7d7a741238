/* family_short.c: what acts for a short time elsewhere than in a supply of one or two capacitors
 *
 * Multipliers of exponential diodes; elements of other steep laws behind sources that pulse; carts
 * that hit walls, are struck and rub; carts that a motion in pulses drags along. Against the
 * classical Runge-Kutta method on equations written here, with steps that are halved until two runs
 * agree. And rows of currents against differences of rows of voltages. */
#include "../unit/session_kit.h"
#include "family.h"
#include "one_node.h"
#include "script.h"

#include <math.h>

#define PI      3.14159265358979323846
#define THERMAL (1.380649e-23 * 300.15 / 1.602176634e-19)
#define LEAKAGE 1e-12
#define MOST    6e5 /* steps of a reference */
#define PLACES  8   /* at which states are compared */
#define STATES  6
#define MISSES  100 /* tolerances by which a run may be off */

static const char *const methods[] = {"auto",  "dop853", "radau", "bdf",
                                      "adams", "ida",    "rk4",   "symplectic"};

/* the larger of two, where no number is larger than any */
static double worse(double a, double b)
{
    return isnan(b) || b > a ? (isnan(b) ? INFINITY : b) : a;
}

/* --- references --- */

typedef struct Problem {
    int n;
    void (*rates)(const void *of, double t, const double *x, double *guess, double *out);
    const void *of;
    double start[STATES];
    double duration, fastest; /* s */
    double error_floor;       /* s a tolerance: by how much errors may bring forward what comes */
} Problem;

static void fixed_steps(const Problem *p, double steps, double out[PLACES][STATES])
{
    const double h = p->duration / (steps * PLACES);
    double x[STATES], k[4][STATES], y[STATES], guess = 0;

    memcpy(x, p->start, sizeof x);
    for (int place = 0; place < PLACES; place++) {
        for (int j = 0; j < steps; j++) {
            const double t = p->duration * place / PLACES + h * j;

            p->rates(p->of, t, x, &guess, k[0]);
            for (int stage = 1; stage < 4; stage++) {
                const double part = stage == 3 ? h : h / 2;

                for (int i = 0; i < p->n; i++)
                    y[i] = x[i] + part * k[stage - 1][i];
                p->rates(p->of, t + part, y, &guess, k[stage]);
            }
            for (int i = 0; i < p->n; i++)
                x[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
        }
        memcpy(out[place], x, sizeof x);
    }
}

/* false: not to be had within so many steps; kinks leave less than order 4, so nothing is
 * extrapolated */
static bool refer(const Problem *p, const double *error, double out[PLACES][STATES])
{
    double coarse[PLACES][STATES] = {0};
    double steps = ceil(p->duration / PLACES / p->fastest);

    if (2 * steps * PLACES > MOST)
        return false;
    fixed_steps(p, steps, coarse);
    for (steps *= 2; steps * PLACES < MOST; steps *= 2) {
        double off = 0;

        fixed_steps(p, steps, out);
        for (int place = 0; place < PLACES; place++)
            for (int i = 0; i < p->n; i++)
                off = worse(off, fabs(out[place][i] - coarse[place][i]) / error[i]);
        if (off < 1)
            return true;
        memcpy(coarse, out, sizeof coarse);
    }
    return false;
}

/* --- runs --- */

/* what errors may come to at a place, in tolerances */
static void find_room(const Problem *p, const double *unit, int place, double x[STATES],
                      double out[STATES])
{
    double guess = 0;

    p->rates(p->of, p->duration / PLACES * (place + 1), x, &guess, out);
    for (int i = 0; i < p->n; i++)
        out[i] = unit[i] + p->error_floor * fabs(out[i]);
}

/* how far the run is off at the places, in tolerances */
static double run_off(Member *m, Kit *kit, const Problem *p, double rtol,
                      const char *const *variables, const double *unit,
                      double right[PLACES][STATES])
{
    double off = 0;

    for (int place = 0; place < PLACES; place++) {
        const double t = place + 1 < PLACES ? p->duration / PLACES * (place + 1) : p->duration;
        double room[STATES] = {0};

        find_room(p, unit, place, right[place], room);
        for (int i = 0; i < p->n; i++) {
            char expression[100];
            double got, missed;

            /* as many as p->n: NOLINTNEXTLINE(clang-analyzer-core.CallAndMessage) */
            (void)snprintf(expression, sizeof expression, "%s at %.17g", variables[i], t);
            got = kit_value(kit, expression);
            missed = fabs(got - right[place][i]) / (rtol * room[i]);
            if (!(missed <= MISSES))
                tell(m, "  %s at %g: %.12g for %.12g\n", variables[i], t, got, right[place][i]);
            off = worse(off, missed);
        }
    }
    tell(m, "off by %.3g tolerances\n", off);
    return off;
}

/* A run by some method against fixed steps. What rk4 misses it says. */
static Verdict compare(Member *m, const Problem *p, Script *text, double rtol,
                       const char *const *variables, const double *unit)
{
    const char *const method = methods[member_one_of(m, (int)(sizeof methods / sizeof methods[0]))];
    const bool is_fixed = strcmp(method, "rk4") == 0 || strcmp(method, "symplectic") == 0;
    double right[PLACES][STATES] = {0}, error[STATES] = {0}, off;
    Kit kit;

    for (int i = 0; i < p->n; i++)
        error[i] = 10 * rtol * unit[i];
    if (!refer(p, error, right))
        return AGREES; /* nobody knows */
    write_piece(text, "simulate %.17g every=%.17g rtol=%.3g method=%s", p->duration,
                p->duration / PLACES, rtol, method);
    if (is_fixed)
        write_piece(text, " step=%.17g", p->fastest);
    write_piece(text, "\n");
    tell(m, "%s", text->text);
    kit = kit_new();
    if (kit_do(&kit, text->text) != CT_OK) {
        tell(m, "%s\n", kit.error.message);
        kit_free(&kit);
        return is_fixed ? AGREES : REFUSED; /* steps that leave all numbers are said, too */
    }
    off = run_off(m, &kit, p, rtol, variables, unit, right);
    if (is_fixed && off > MISSES && kit_do(&kit, "show run\n") == CT_OK &&
        strstr(kit.text, "controls no error") != NULL)
        off = 0;
    kit_free(&kit);
    return off <= MISSES ? AGREES : DISAGREES;
}

/* --- sources --- */

typedef enum Shape { SINE, PULSES, BURST, TRAPEZOID, SHAPES } Shape;

typedef struct Source {
    Shape shape;
    double peak, f, duty; /* duty: of a period that a pulse is wide */
    double top, width;    /* s: of a burst and a trapezoid */
} Source;

static double source(const Source *s, double t)
{
    const double w = 2 * PI * s->f;

    switch (s->shape) {
    case SINE:
        return s->peak * sin(w * t);
    case PULSES:
        return s->peak * exp((cos(w * t) - 1) / (s->duty * s->duty));
    case BURST:
        return s->peak * exp(-(t - s->top) / s->width * ((t - s->top) / s->width));
    default: /* edges of `width`, and as long between */
        t = (t - s->top) / s->width;
        return s->peak * fmax(0, fmin(1, fmin(t, 3 - t)));
    }
}

/* and its rate and the rate of that, of a burst */
static double burst_rate(const Source *s, double t, double *second)
{
    const double x = (t - s->top) / s->width, e = s->peak * exp(-x * x);

    *second = e * (4 * x * x - 2) / (s->width * s->width);
    return -2 * x * e / s->width;
}

static void print_source(const Source *s, Script *out)
{
    const double w = 2 * PI * s->f;

    switch (s->shape) {
    case SINE:
        write_piece(out, "%.17g*sin(%.17g*t)", s->peak, w);
        break;
    case PULSES:
        write_piece(out, "%.17g*exp((cos(%.17g*t) - 1)/%.17g)", s->peak, w, s->duty * s->duty);
        break;
    case BURST:
        write_piece(out, "%.17g*exp(-((t - %.17g)/%.17g)^2)", s->peak, s->top, s->width);
        break;
    default:
        write_piece(out, "pulse(t, 0, %.17g, %.17g, %.17g, %.17g, %.17g)", s->peak, s->top,
                    s->width, s->width, s->width);
    }
}

static Source random_source(Member *m, double duration)
{
    Source s = {.shape = (Shape)member_one_of(m, SHAPES)};

    s.peak = member_decades(m, 3, 100);
    s.f = member_between(m, 2, 6) / duration;
    s.duty = member_between(m, 0.1, 0.5);
    s.width = duration * member_decades(m, 1e-4, 3e-2);
    s.top = duration * member_between(m, 0.1, 0.8);
    return s;
}

/* the shortest time in which it goes somewhere */
static double source_time(const Source *s)
{
    return s->shape == SINE ? 0.1 / s->f : s->shape == PULSES ? s->duty / s->f / 10 : s->width / 3;
}

/* --- multipliers --- */

typedef struct Multiplier {
    Source source;
    int stages;
    double Rs, C, RL, Is, n;
} Multiplier;

static double diode(const Multiplier *s, double v, double *slope)
{
    return diode_current(s->Is, s->n * THERMAL, LEAKAGE, v, slope);
}

/* Currents up the columns: of the diodes into node a_k, then out of it; x holds voltages of the
 * capacitors from column a's foot up, then of those from ground up. Returns all that leaves column
 * a. */
static double columns(const Multiplier *s, const double *x, double v, double *into, double *out,
                      double *slope)
{
    double a = v, b = 0, sum = 0;

    *slope = 0;
    for (int k = 0; k < s->stages; k++) {
        double g;

        a -= x[k];
        into[k] = diode(s, b - a, &g);
        *slope += g;
        b += x[s->stages + k];
        out[k] = diode(s, a - b, &g);
        *slope += g;
        sum += out[k] - into[k];
    }
    return sum;
}

static double multiplier_node(const void *of, double t, const double *x, double v, double *slope)
{
    const Multiplier *s = of;
    double into[STATES] = {0}, out[STATES] = {0};
    const double i = columns(s, x, v, into, out, slope);

    *slope += 1 / s->Rs;
    return i - (source(&s->source, t) - v) / s->Rs;
}

static void multiplier_rates(const void *of, double t, const double *x, double *guess, double *rate)
{
    const Multiplier *s = of;
    double into[STATES], out[STATES], slope, a = 0, b = 0, load = 0;

    *guess = solve_node(multiplier_node, s, t, x, 10 * s->stages * s->source.peak + 10, *guess);
    (void)columns(s, x, *guess, into, out, &slope);
    for (int k = 0; k < s->stages; k++)
        load += x[s->stages + k] / s->RL;
    for (int k = s->stages - 1; k >= 0; k--) { /* from the top: all above goes through */
        /* stages are fewer: NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult) */
        a += out[k] - into[k];
        b += out[k];
        rate[k] = a / s->C;
        rate[s->stages + k] = (b - load) / s->C;
        b -= into[k];
    }
}

static Verdict multipliers(Member *m)
{
    static const char *const names[2][STATES] = {
        {"Ca1.v", "Ca2.v", "Cb1.v", "Cb2.v"},
        {"Ca1.v", "Ca2.v", "Ca3.v", "Cb1.v", "Cb2.v", "Cb3.v"}};
    const double f = member_decades(m, 10, 1e5), rtol = pow(10, -member_between(m, 3, 9));
    Multiplier s = {
        .source = {.shape = (Shape)member_one_of(m, 2), .peak = member_decades(m, 3, 200), .f = f}};
    Problem p = {.rates = multiplier_rates, .of = &s};
    double unit[STATES] = {0};
    Script text = {0};

    s.stages = 2 + member_one_of(m, 2);
    s.source.duty = member_between(m, 0.15, 0.5);
    s.Rs = member_decades(m, 0.1, 1000);
    s.C = member_decades(m, 1e-2, 0.3) / f / s.Rs;
    s.RL = member_decades(m, 10, 1e4) / f / s.C;
    s.Is = member_decades(m, 1e-15, 1e-9);
    s.n = member_between(m, 1, 2);
    p.n = 2 * s.stages;
    p.duration = member_between(m, 2, 5) / f;
    p.fastest = fmin(s.Rs * s.C / 6, source_time(&s.source));
    for (int i = 0; i < STATES; i++)
        unit[i] = fmax(s.source.peak, 1);
    write_piece(&text, "vsource V p 0 ");
    print_source(&s.source, &text);
    write_piece(&text, "\nresistor Rs p s %.17g\nresistor RL b%d 0 %.17g\n", s.Rs, s.stages, s.RL);
    for (int k = 1; k <= s.stages; k++) {
        char a[16] = "s", b[16] = "0";

        if (k > 1) {
            (void)snprintf(a, sizeof a, "a%d", k - 1);
            (void)snprintf(b, sizeof b, "b%d", k - 1);
        }
        write_piece(&text,
                    "capacitor Ca%d %s a%d %.17g\ncapacitor Cb%d b%d %s %.17g\n"
                    "diode Da%d %s a%d Is=%.17g n=%.17g\ndiode Db%d a%d b%d Is=%.17g n=%.17g\n"
                    "init Ca%d.v = 0, Cb%d.v = 0\n",
                    k, a, k, s.C, k, k, b, s.C, k, b, k, s.Is, s.n, k, k, k, s.Is, s.n, k, k);
    }
    return compare(m, &p, &text, rtol, names[s.stages - 2], unit);
}

/* --- elements of other laws --- */

typedef enum Law { POWER, TANH, SINH, LINES, IDEAL, LAWS } Law;

#define NOTHING 1e-9 /* of what is in series: an ideal part's resistance, and conductance */

typedef struct Charger {
    Source source;
    Law law;
    int exponent;
    double Rs, C, RL, I, U; /* the law: I at about U */
} Charger;

static double law(const Charger *s, double v, double *slope)
{
    const double x = v / s->U;

    switch (s->law) {
    case POWER:
        *slope = s->I * s->exponent * pow(x, s->exponent - 1) / s->U;
        return s->I * pow(x, s->exponent);
    case TANH:
        *slope = s->I / s->U / (cosh(fmin(fabs(x), 300)) * cosh(fmin(fabs(x), 300)));
        return s->I * tanh(x);
    case SINH:
        *slope = s->I * cosh(x) / s->U;
        return s->I * sinh(x);
    case LINES:
        *slope = v > 0 ? s->I / s->U : NOTHING / s->Rs;
        return *slope * v;
    default:
        *slope = v > 0 ? 1 / (NOTHING * s->Rs) : 0;
        return *slope * v;
    }
}

static void print_law(const Charger *s, Script *text)
{
    switch (s->law) {
    case POWER:
        write_piece(text, "isource N s b %.17g*(N.v/%.17g)^%d\n", s->I, s->U, s->exponent);
        break;
    case TANH:
    case SINH:
        write_piece(text, "isource N s b %.17g*%s(N.v/%.17g)\n", s->I,
                    s->law == TANH ? "tanh" : "sinh", s->U);
        break;
    case LINES:
        write_piece(text, "diode N s b Ron=%.17g Roff=%.17g\n", s->U / s->I, s->Rs / NOTHING);
        break;
    default:
        write_piece(text, "diode N s b\n");
    }
}

static double charger_node(const void *of, double t, const double *x, double v, double *slope)
{
    const Charger *s = of;
    const double i = law(s, v - x[0], slope);

    *slope += 1 / s->Rs;
    return i - (source(&s->source, t) - v) / s->Rs;
}

static void charger_rates(const void *of, double t, const double *x, double *guess, double *rate)
{
    const Charger *s = of;

    *guess = solve_node(charger_node, s, t, x, s->source.peak + fabs(x[0]) + 1, *guess);
    rate[0] = ((source(&s->source, t) - *guess) / s->Rs - x[0] / s->RL) / s->C;
}

static Verdict elements(Member *m)
{
    static const char *const names[] = {"C.v"};
    const double rtol = pow(10, -member_between(m, 3, 10));
    Charger s = {.law = (Law)member_one_of(m, LAWS), .exponent = 3 + 2 * member_one_of(m, 8)};
    Problem p = {.n = 1, .rates = charger_rates, .of = &s};
    double fast, unit[1] = {0};
    Script text = {0};

    p.duration = member_decades(m, 1e-4, 100);
    s.source = random_source(m, p.duration);
    fast = p.duration * member_decades(m, 1e-3, 0.1);
    s.Rs = member_decades(m, 0.1, 1000);
    s.C = fast / s.Rs;
    s.RL = member_decades(m, 0.3, 1e3) * p.duration / s.C;
    s.U = s.source.peak *
          (s.law == POWER ? member_between(m, 0.2, 0.8) : member_decades(m, 0.02, 0.3));
    s.I = s.source.peak / s.Rs * member_decades(m, 1e-3, 1);
    p.fastest = fmin(fast / 3, source_time(&s.source) / 3);
    unit[0] = fmax(s.source.peak, 1);
    write_piece(&text, "vsource V p 0 ");
    print_source(&s.source, &text);
    write_piece(&text,
                "\nresistor Rs p s %.17g\ncapacitor C b 0 %.17g\nresistor RL b 0 %.17g\n"
                "init C.v = 0\n",
                s.Rs, s.C, s.RL);
    print_law(&s, &text);
    return compare(m, &p, &text, rtol, names, unit);
}

/* --- carts --- */

typedef enum Wall { RAMP, HERTZ, SCREEN, WALLS } Wall;

/* between walls at 0 and 1 m */
typedef struct Cart {
    Source source; /* of force */
    Wall wall;
    double mass, stiffness, friction, slow, reach;
} Cart;

/* force of a wall that is `s` away */
static double push(const Cart *c, double s)
{
    switch (c->wall) {
    case RAMP:
        return c->stiffness * fmax(0, -s);
    case HERTZ:
        return c->stiffness * pow(fmax(0, -s), 1.5);
    default:
        return c->stiffness * exp(-s / c->reach);
    }
}

/* the type is that of all rates: NOLINTNEXTLINE(readability-non-const-parameter) */
static void cart_rates(const void *of, double t, const double *x, double *guess, double *rate)
{
    const Cart *c = of;

    (void)guess;
    rate[0] = x[1];
    rate[1] = (push(c, x[0]) - push(c, 1 - x[0]) - c->friction * tanh(x[1] / c->slow) +
               source(&c->source, t)) /
              c->mass;
}

static void print_push(const Cart *c, const char *s, Script *text)
{
    if (c->wall == RAMP)
        write_piece(text, "%.17g*ramp(-(%s))", c->stiffness, s);
    else if (c->wall == HERTZ)
        write_piece(text, "%.17g*ramp(-(%s))^1.5", c->stiffness, s);
    else
        write_piece(text, "%.17g*exp(-(%s)/%.17g)", c->stiffness, s, c->reach);
}

static Verdict carts(Member *m)
{
    static const char *const names[] = {"s", "s'"};
    const double rtol = pow(10, -member_between(m, 3, 8)), speed = member_decades(m, 0.1, 10);
    Cart c = {.wall = (Wall)member_one_of(m, WALLS), .mass = member_decades(m, 0.1, 10)};
    Problem p = {
        .n = 2, .rates = cart_rates, .of = &c, .start = {member_between(m, 0.2, 0.8), speed}};
    double contact, unit[2] = {0};
    Script text = {0};

    p.duration = member_between(m, 0.5, 4) / speed;
    contact = member_decades(m, 1e-4, 1e-2) / speed; /* how long it touches, s */
    c.reach = contact * speed / 10;
    c.stiffness = c.mass / (contact * contact) * 10;
    if (c.wall == HERTZ)
        c.stiffness /= sqrt(contact * speed);
    if (c.wall == SCREEN)
        c.stiffness = c.mass * speed * speed / c.reach * member_decades(m, 1e-3, 1);
    c.slow = speed * member_decades(m, 1e-3, 0.1);
    c.friction = member_one_of(m, 2) * c.mass * speed / p.duration * member_between(m, 0.1, 0.6);
    c.source = random_source(m, p.duration);
    c.source.shape = member_one_of(m, 2) == 0 ? BURST : TRAPEZOID;
    c.source.peak = c.mass * speed / c.source.width * member_between(m, -0.5, 0.5);
    p.fastest = fmin(contact / 20, c.source.width / 5);
    if (c.friction > 0)
        p.fastest = fmin(p.fastest, c.slow * c.mass / c.friction);
    p.error_floor = 1 / speed;
    unit[0] = fmax(1, p.duration); /* the speed's tolerance lasts so long */
    unit[1] = fmax(1, speed);
    write_piece(&text,
                "scene planar\ngravity [0, 0]\nbody b mass=%.17g\nprismatic s ground b axis=x\n"
                "init s = %.17g, s' = %.17g\nactuator left s force=",
                c.mass, p.start[0], p.start[1]);
    print_push(&c, "s", &text);
    write_piece(&text, "\nactuator right s force=-");
    print_push(&c, "1 - s", &text);
    write_piece(&text,
                "\nactuator rub s force=-%.17g*tanh(s'/%.17g)\nactuator blow s force=", c.friction,
                c.slow);
    print_source(&c.source, &text);
    write_piece(&text, "\n");
    return compare(m, &p, &text, rtol, names, unit);
}

/* --- motions in pulses --- */

typedef struct Tow {
    Source source; /* of the first cart's place */
    double mass, k, d;
} Tow;

/* the second cart, by where it is from the first */
/* the type is that of all rates: NOLINTNEXTLINE(readability-non-const-parameter) */
static void tow_rates(const void *of, double t, const double *x, double *guess, double *rate)
{
    const Tow *c = of;
    double second;

    (void)guess;
    (void)burst_rate(&c->source, t, &second);
    rate[0] = x[1];
    rate[1] = -(c->k * x[0] + c->d * x[1]) / c->mass - second;
}

static Verdict tows(Member *m)
{
    static const char *const names[] = {"s", "s'"};
    const double rtol = pow(10, -member_between(m, 3, 9));
    Tow c = {.mass = member_decades(m, 0.1, 10)};
    Problem p = {.n = 2, .rates = tow_rates, .of = &c};
    double unit[2] = {0}, w;
    Script text = {0};

    p.duration = member_decades(m, 0.1, 1e3);
    c.source = random_source(m, p.duration);
    c.source.shape = BURST;
    c.source.width = p.duration * member_decades(m, 3e-4, 3e-2);
    c.source.peak = member_decades(m, 1e-2, 10);
    w = member_between(m, 1, 20) / p.duration;
    c.k = c.mass * w * w;
    c.d = c.mass * w * member_between(m, 0, 1);
    p.fastest = c.source.width / 5;
    unit[1] = fmax(1, c.source.peak / c.source.width);
    unit[0] = fmax(1, unit[1] / w); /* where an error of the speed leads */
    write_piece(
        &text,
        "scene planar\ngravity [0, 0]\nbody a mass=1\nprismatic d ground a axis=x\n"
        "body b mass=%.17g\nprismatic s a b axis=x\ndamper l s d=%.17g\nspring k s k=%.17g\n"
        "init s = 0, s' = 0\ndriver D d = ",
        c.mass, c.d, c.k);
    print_source(&c.source, &text);
    write_piece(&text, "\n");
    return compare(m, &p, &text, rtol, names, unit);
}

/* --- rows --- */

/* i = C v' in the rows themselves: v' by differences of orders 4 and 6, which tell how far they are
 * to be believed */
static Verdict rows(Member *m)
{
    const char *const method = methods[member_one_of(m, 6)];
    const double rtol = pow(10, -member_between(m, 4, 9)), f = member_decades(m, 10, 1e5);
    const double Rs = member_decades(m, 0.1, 1000), C = member_decades(m, 1e-2, 0.3) / f / Rs;
    const double duration = 3 / f, every = duration / 3000, peak = member_decades(m, 3, 200);
    ct_cursor cursor = {.text = "table C.v, C.i", .line = 1};
    const ct_expression *items[2];
    ct_statement *statement = NULL;
    double *values = NULL, off = 0, most = 0;
    char **names = NULL;
    int count = 0, columns_of = 0;
    Script text = {0};
    Kit kit = kit_new();

    write_piece(&text,
                "vsource V p 0 %.17g*sin(%.17g*t)\nresistor Rs p s %.17g\n"
                "diode D s b Is=%.17g n=%.17g\ncapacitor C b 0 %.17g\nresistor RL b 0 %.17g\n"
                "init C.v = 0\nsimulate %.17g every=%.17g rtol=%.3g method=%s\n",
                peak, 2 * PI * f, Rs, member_decades(m, 1e-15, 1e-9), member_between(m, 1, 2), C,
                member_decades(m, 1, 1e4) / f / C, duration, every, rtol, method);
    tell(m, "%s", text.text);
    if (kit_do(&kit, text.text) != CT_OK ||
        ct_parse(&cursor, false, &statement, &kit.error) != CT_OK) {
        tell(m, "%s\n", kit.error.message);
        kit_free(&kit);
        return REFUSED;
    }
    for (int i = 0; i < 2; i++)
        items[i] = ct_operand(statement, i);
    if (ct_table(kit.session, items, 2, 0, &values, &count, &columns_of, &names, &kit.error) ==
        CT_OK)
        for (int r = 3; r + 3 < count; r++) {
            const double *v = values + (ptrdiff_t)r * columns_of + 1;
            const int c = columns_of;
            const double four = (8 * (v[c] - v[-c]) - (v[2 * c] - v[-2 * c])) / (12 * every);
            const double six =
                (45 * (v[c] - v[-c]) - 9 * (v[2 * c] - v[-2 * c]) + (v[3 * c] - v[-3 * c])) /
                (60 * every);
            const double two = (v[c] - v[-c]) / (2 * every);
            const double noise = C * (MISSES * rtol * fmax(peak, 1) / every + 3 * fabs(six - four) +
                                      fabs(four - two));

            off = worse(off, fabs(v[1] - C * six) / noise);
            most = fmax(most, fabs(v[1]) / noise);
        }
    else
        off = INFINITY;
    tell(m, "off by %.3g of what differences leave, currents up to %.3g of it\n", off, most);
    ct_free(values);
    ct_words_free(names);
    ct_statement_free(statement);
    kit_free(&kit);
    return off <= 1 ? AGREES : DISAGREES;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"multipliers_are_what_fixed_steps_find", 3, 0, 1e-3, multipliers},
        {"steep_elements_are_what_fixed_steps_find", 12, 0, 1e-3, elements},
        {"carts_hit_and_struck_are_what_fixed_steps_find", 8, 0, 1e-3, carts},
        {"carts_dragged_in_pulses_are_what_fixed_steps_find", 30, 0.01, 1e-3, tows},
        {"rows_obey_i_is_C_dv", 12, 0, 0, rows},
    };

    (void)test_faults; /* verdicts count here */
    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
