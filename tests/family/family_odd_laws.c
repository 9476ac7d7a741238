/* family_odd_laws.c: networks that store nothing, with a law sign(x)*f(abs(x))
 *
 * The oracle: the one node's balance, which rises with its voltage, by halves. Sources cross 0,
 * where the law bends or, where f(0) > 0, jumps. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

#include <math.h>

#define DURATION 3.0
#define LOOKS    12
#define HALVES   200
#define PI       3.14159265358979323846
#define WIDEST   1e4  /* V: no node has more */
#define CLOSE    1e-9 /* of the largest voltage, */
#define RELATIVE 1e-9 /* and of itself */

typedef enum Law { LOGARITHM, LINE, POWER, EXPONENTIAL, ROOT, SATURATED, CLIPPED, LAWS } Law;

static const char *const names[] = {"R3.v", "R3.i", "R1.i"};

typedef enum Of { VOLTAGE, CURRENT, SERIES } Of;

typedef struct Network {
    Law law;
    Of of;           /* what it is a law of */
    bool is_current; /* the source */
    double peak, pace, phase, R1, R3;
    double size, scale, jump;
} Network;

/* --- the oracle --- */

static double odd_law(const Network *n, double x)
{
    const double r = fabs(x) / n->scale;
    double f = 0;

    switch (n->law) {
    case LOGARITHM:
        f = log1p(r);
        break;
    case LINE:
        f = r;
        break;
    case POWER:
        f = r * sqrt(r);
        break;
    case EXPONENTIAL:
        f = expm1(fmin(r, 600));
        break;
    case ROOT:
        f = sqrt(r);
        break;
    case SATURATED:
        f = r / (1 + r);
        break;
    default:
        f = fmin(r, 1);
    }
    return (x > 0 ? 1 : x < 0 ? -1 : 0) * (n->jump + n->size * f);
}

/* what leaves the node beyond what comes */
static double excess(const Network *n, double source, double v)
{
    const double comes = n->is_current ? source : (source - v) / n->R1;
    const double x = n->of == VOLTAGE ? v : n->of == CURRENT ? v / n->R3 : comes;

    return v / n->R3 + odd_law(n, x) - comes;
}

static double source_at(const Network *n, double t)
{
    return n->peak * sin(n->pace * t + n->phase);
}

static double voltage(const Network *n, double t)
{
    const double source = source_at(n, t);
    /* in series the balance rises as far as the source reaches */
    const double widest = n->of == SERIES && !n->is_current ? n->peak : WIDEST;
    double low = -widest, high = widest;

    for (int k = 0; k < HALVES; k++) {
        const double middle = (low + high) / 2;

        if (excess(n, source, middle) > 0)
            high = middle;
        else
            low = middle;
    }
    return (low + high) / 2;
}

/* --- members --- */

static void write_law(const Network *n, Script *text)
{
    static const char *const forms[] = {"log(1 + abs(%s)/%.17g)", "abs(%s)/%.17g",
                                        "(abs(%s)/%.17g)^1.5",    "(exp(abs(%s)/%.17g) - 1)",
                                        "sqrt(abs(%s)/%.17g)",    NULL,
                                        "min(abs(%s)/%.17g, 1)"};
    const char *x = names[n->of];

    write_piece(text, "isource N b 0 sign(%s)*", x);
    if (n->jump > 0)
        write_piece(text, "(%.17g + ", n->jump);
    write_piece(text, "%.17g*", n->size);
    if (n->law == SATURATED)
        write_piece(text, "abs(%s)/(%.17g + abs(%s))", x, n->scale, x);
    else {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
        write_piece(text, forms[n->law], x, n->scale);
#pragma GCC diagnostic pop
    }
    write_piece(text, "%s\n", n->jump > 0 ? ")" : "");
}

static void write_network(const Network *n, Script *text)
{
    write_piece(text, "%s %.17g*sin(%.17g*t + %.17g)\n",
                n->is_current ? "isource S 0 a" : "vsource S a 0", n->peak, n->pace, n->phase);
    write_piece(text, "resistor R1 a b %.17g\nresistor R3 b 0 %.17g\n", n->R1, n->R3);
    write_law(n, text);
    write_piece(text, "simulate %.17g\n", DURATION);
}

/* at instants of no meaning, and just behind each at which the source crosses 0 */
static Verdict look(Member *m, Kit *kit, const Network *n)
{
    const double largest = n->peak * (n->is_current ? n->R3 : 1);
    bool good = true;

    for (int k = 0; k < 3 * LOOKS && good; k++) {
        const double crossing = (PI * (k - LOOKS) - n->phase) / n->pace;
        const double t = k < LOOKS ? DURATION * (k + 0.37) / LOOKS : crossing + 1e-3;
        char expression[64];
        double got, right;

        if (!(t >= 0 && t <= DURATION))
            continue;
        right = voltage(n, t);
        (void)snprintf(expression, sizeof expression, "R3.v at %.17g", t);
        got = kit_value(kit, expression);
        if (isnan(got)) /* an error of its own */
            return REFUSED;
        good = keeps(m, expression, fabs(got - right), CLOSE * largest + RELATIVE * fabs(right));
    }
    return good ? AGREES : DISAGREES;
}

static Verdict compare(Member *m, const Network *n)
{
    Script text = {0};
    Verdict verdict = REFUSED;
    Kit kit = kit_new();

    write_network(n, &text);
    tell(m, "%s", text.text);
    if (kit_do(&kit, text.text) != CT_OK)
        tell(m, "%s\n", kit.error.message);
    else
        verdict = look(m, &kit, n);
    kit_free(&kit);
    return verdict;
}

static Network random_network(Member *m)
{
    Network n = {.law = (Law)member_one_of(m, LAWS), .of = (Of)member_one_of(m, 2)};

    n.is_current = member_one_of(m, 2) == 0;
    n.peak = member_between(m, 0.5, 5);
    n.pace = member_between(m, 1, 10);
    n.phase = member_one_of(m, 2) == 0 ? 0 : member_between(m, 0, 6);
    n.R1 = member_decades(m, 1, 100);
    n.R3 = member_decades(m, 1, 100);
    n.size = member_decades(m, 1e-2, 3);
    n.scale = member_decades(m, 0.1, 3);
    return n;
}

static Verdict bend(Member *m)
{
    const Network n = random_network(m);

    return compare(m, &n);
}

/* Where a law jumps the balance may have no solution but between: that may be refused, and
 * nothing else may be told. */
static Verdict jump(Member *m)
{
    Network n = random_network(m);

    n.jump = member_decades(m, 1e-2, 1);
    return compare(m, &n);
}

/* told wrong or refused once */
static Verdict known(Member *m)
{
    static const struct {
        Law law;
        Of of;
        double size;
    } laws[] = {{LOGARITHM, VOLTAGE, 1}, {LINE, VOLTAGE, 0.3}, {ROOT, VOLTAGE, 1},
                {POWER, SERIES, 1},      {LINE, SERIES, 0.3},  {EXPONENTIAL, SERIES, 1}};
    const int i = m->number / 2 % (int)(sizeof laws / sizeof laws[0]);
    Network n = {.law = laws[i].law,
                 .of = laws[i].of,
                 .size = laws[i].size,
                 .scale = 1,
                 .is_current = m->number % 2 != 0,
                 .peak = 2,
                 .pace = 3,
                 .R1 = 10,
                 .R3 = 4};

    return compare(m, &n);
}

/* told on the far side of their jump once */
static Verdict far_off(Member *m)
{
    static const Network networks[] = {
        {LOGARITHM, VOLTAGE, false, 1.1, 3.6, 4.3, 6.65, 3.06, 0.834, 0.555, 0.0186},
        {ROOT, VOLTAGE, true, 1.37, 9.2, 2.85, 16.4, 8.77, 1.18, 1.04, 0.0109}};

    return compare(m, &networks[m->number % 2]);
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"odd_laws_that_bend_follow_the_balance", 40, 0.02, 0, bend},
        {"odd_laws_that_failed_once_follow_it", 12, 0, 0, known},
        {"odd_laws_that_jump_follow_it_or_are_refused", 40, 1, 0, jump},
        {"odd_laws_that_jumped_far_off_do_so_no_more", 2, 1, 0, far_off},
    };

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
