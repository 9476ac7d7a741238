/* family_response.c: transfer functions and equivalents in symbols of random linear networks,
 * against nodal analysis in complex numbers
 *
 * The oracle stamps each element into a matrix of node potentials and currents (Ho, Ruehli and
 * Brennan 1975), at a few complex frequencies, and solves it; what cotree prints is read as text by
 * a reader of its own and evaluated there. Peaks and notches of what bode draws are held against
 * those of a sum of branches, searched on a grid of its own. */
#include "../unit/session_kit.h"
#include "family.h"

#include <complex.h>
#include <ctype.h>

#undef I /* a current source here */

typedef double complex Complex;

enum { NODES = 6, ELEMENTS = 12, SIZE = NODES + 2 * ELEMENTS + 2, ROOM = 4000 };

typedef enum Kind { R, L, C, V, I, VCVS, VCCS, CCVS, CCCS, OPAMP, TRANSFORMER, GYRATOR } Kind;

static const struct {
    const char *verb, *key;
    int nodes;
} kinds[] = {[R] = {"resistor", "", 2},
             [L] = {"inductor", "", 2},
             [C] = {"capacitor", "", 2},
             [V] = {"vsource", "", 2},
             [I] = {"isource", "", 2},
             [VCVS] = {"vcvs", "gain=", 4},
             [VCCS] = {"vccs", "gain=", 4},
             [CCVS] = {"ccvs", "gain=", 2},
             [CCCS] = {"cccs", "gain=", 2},
             [OPAMP] = {"opamp", "", 3},
             [TRANSFORMER] = {"transformer", "n=", 4},
             [GYRATOR] = {"gyrator", "r=", 4}};

typedef struct Element {
    Kind kind;
    int node[4]; /* 0: the datum */
    int of;      /* whose current controls it; the coil that it is coupled with, or -1 */
    double value, mutual;
    bool is_symbol;
} Element;

typedef struct Net {
    int nodes, count;
    Element at[ELEMENTS];
    char text[ROOM];
} Net;

/* --- drawing --- */

static void draw_element(Member *member, Net *net, Kind kind)
{
    Element *e = &net->at[net->count++];

    *e = (Element){.kind = kind,
                   .of = -1,
                   .value = kind >= VCVS ? member_between(member, -2, 2)
                                         : member_between(member, 0.3, 3),
                   .is_symbol = member_one_of(member, 3) > 0};
    for (int k = 0; k < 4; k++)
        do
            e->node[k] = member_one_of(member, net->nodes + 1);
        while (k % 2 == 1 && e->node[k] == e->node[k - 1]);
}

static void draw_net(Member *member, Net *net)
{
    const int extra = 2 + member_one_of(member, ELEMENTS - NODES - 2);

    memset(net, 0, sizeof *net);
    net->nodes = 2 + member_one_of(member, NODES - 2);
    draw_element(member, net, member_one_of(member, 2) == 0 ? V : I);
    /* one that hangs together */
    for (int n = 1; n <= net->nodes && net->count < ELEMENTS; n++) {
        draw_element(member, net, (Kind)member_one_of(member, 3));
        net->at[net->count - 1].node[0] = n;
        net->at[net->count - 1].node[1] = member_one_of(member, n);
    }
    for (int i = 0; i < extra && net->count < ELEMENTS; i++) {
        static const Kind all[] = {R,    R,    L,    C,    C,     V,           I,
                                   VCVS, VCCS, CCVS, CCCS, OPAMP, TRANSFORMER, GYRATOR};
        const Kind kind = all[member_one_of(member, (int)(sizeof all / sizeof all[0]))];

        draw_element(member, net, kind);
        if (kind == CCVS || kind == CCCS)
            net->at[net->count - 1].of = 0;
    }
    for (int i = 0; i < net->count; i++)
        for (int k = i + 1; k < net->count; k++)
            if (net->at[i].kind == L && net->at[k].kind == L && net->at[i].of < 0 &&
                net->at[k].of < 0 && member_one_of(member, 2) == 0) {
                net->at[k].of = i;
                net->at[i].of = k;
                net->at[k].mutual =
                    member_between(member, -0.9, 0.9) * sqrt(net->at[i].value * net->at[k].value);
            }
}

static void put(Net *net, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void put(Net *net, const char *format, ...)
{
    const size_t length = strlen(net->text);
    va_list arguments;

    va_start(arguments, format);
    (void)vsnprintf(net->text + length, sizeof net->text - length, format, arguments);
    va_end(arguments);
}

static void write_net(Net *net)
{
    for (int i = 0; i < net->count; i++) {
        const Element *e = &net->at[i];

        if (e->is_symbol)
            put(net, "p%d = %.15g\n", i, e->value);
        put(net, "%s e%d", kinds[e->kind].verb, i);
        for (int k = 0; k < kinds[e->kind].nodes; k++)
            put(net, e->node[k] > 0 ? " n%d" : " %d", e->node[k]);
        if (e->kind == CCVS || e->kind == CCCS)
            put(net, " of=e%d.i", e->of);
        if (e->kind == OPAMP)
            put(net, "\n");
        else if (e->is_symbol)
            put(net, " %sp%d\n", kinds[e->kind].key, i);
        else
            put(net, " %s%.15g\n", kinds[e->kind].key, e->value);
    }
    for (int i = 0; i < net->count; i++)
        if (net->at[i].kind == L && net->at[i].of >= 0 && net->at[i].of < i)
            put(net, "coupling k%d e%d e%d M=%.15g\n", i, net->at[i].of, i, net->at[i].mutual);
}

/* --- the oracle --- */

typedef struct Nodal {
    int size;
    Complex a[SIZE][SIZE], b[SIZE];
} Nodal;

/* potentials stand first, the datum nowhere; then two currents an element */
static int place_of(const Net *net, int element, int which)
{
    return net->nodes + 2 * element + which;
}

static void stamp(Nodal *m, int row, int node, Complex by)
{
    if (node > 0)
        m->a[row][node - 1] += by;
}

/* current of a place flows from plus to minus */
static void flows(Nodal *m, int place, int plus, int minus)
{
    if (plus > 0)
        m->a[plus - 1][place] += 1;
    if (minus > 0)
        m->a[minus - 1][place] -= 1;
}

static void across(Nodal *m, int row, const int *node, Complex by)
{
    stamp(m, row, node[0], by);
    stamp(m, row, node[1], -by);
}

static void stamp_element(const Net *net, int i, Complex s, Nodal *m)
{
    const Element *e = &net->at[i];
    const int own = place_of(net, i, 0), other = place_of(net, i, 1);
    const double x = e->value;

    if (e->kind == OPAMP) {
        flows(m, own, e->node[2], 0);
        across(m, own, e->node, 1);
    } else {
        flows(m, own, e->node[0], e->node[1]);
    }
    if (e->kind == TRANSFORMER || e->kind == GYRATOR)
        flows(m, other, e->node[2], e->node[3]);
    else
        m->a[other][other] = 1;
    switch (e->kind) {
    case R:
        across(m, own, e->node, 1);
        m->a[own][own] -= x;
        break;
    case L:
        across(m, own, e->node, 1);
        m->a[own][own] -= s * x;
        if (e->of >= 0)
            m->a[own][place_of(net, e->of, 0)] -= s * net->at[e->of > i ? e->of : i].mutual;
        break;
    case C:
        across(m, own, e->node, -s * x);
        m->a[own][own] += 1;
        break;
    case V:
        across(m, own, e->node, 1);
        break;
    case I:
        m->a[own][own] += 1;
        break;
    case VCVS:
        across(m, own, e->node, 1);
        across(m, own, e->node + 2, -x);
        break;
    case VCCS:
        m->a[own][own] += 1;
        across(m, own, e->node + 2, -x);
        break;
    case CCVS:
        across(m, own, e->node, 1);
        m->a[own][place_of(net, e->of, 0)] -= x;
        break;
    case CCCS:
        m->a[own][own] += 1;
        m->a[own][place_of(net, e->of, 0)] -= x;
        break;
    case OPAMP:
        break;
    case TRANSFORMER:
        across(m, own, e->node, 1);
        across(m, own, e->node + 2, -x);
        m->a[other][other] += 1;
        m->a[other][own] += x;
        break;
    case GYRATOR:
        across(m, own, e->node, 1);
        m->a[own][other] -= x;
        across(m, other, e->node + 2, 1);
        m->a[other][own] += x;
        break;
    }
}

/* false: singular; the answer stands in b */
static bool nodal_solve(Nodal *m)
{
    double largest = 0, least = INFINITY;

    for (int k = 0; k < m->size; k++) {
        int best = k;

        for (int r = k; r < m->size; r++)
            best = cabs(m->a[r][k]) > cabs(m->a[best][k]) ? r : best;
        for (int c = 0; c < m->size; c++) {
            const Complex x = m->a[k][c];

            m->a[k][c] = m->a[best][c];
            m->a[best][c] = x;
        }
        const Complex x = m->b[k];
        m->b[k] = m->b[best];
        m->b[best] = x;
        largest = fmax(largest, cabs(m->a[k][k]));
        least = fmin(least, cabs(m->a[k][k]));
        if (least <= 1e-9 * largest)
            return false;
        for (int r = 0; r < m->size; r++) {
            const Complex by = r != k ? m->a[r][k] / m->a[k][k] : 0;

            for (int c = k; c < m->size; c++)
                m->a[r][c] -= by * m->a[k][c];
            m->b[r] -= by * m->b[k];
        }
    }
    for (int k = 0; k < m->size; k++)
        m->b[k] /= m->a[k][k];
    return true;
}

/* v between two nodes where source `which` is 1, or (-1) a current 1 is fed in there */
static bool nodal_answer(const Net *net, Complex s, int which, const int *node, Complex *out)
{
    static Nodal m;

    memset(&m, 0, sizeof m);
    m.size = net->nodes + 2 * net->count;
    for (int i = 0; i < net->count; i++)
        stamp_element(net, i, s, &m);
    if (which >= 0)
        m.b[place_of(net, which, 0)] = 1;
    else
        for (int k = 0; k < 2; k++)
            if (node[k] > 0)
                m.b[node[k] - 1] = k == 0 ? 1 : -1;
    if (!nodal_solve(&m))
        return false;
    *out = (node[0] > 0 ? m.b[node[0] - 1] : 0) - (node[1] > 0 ? m.b[node[1] - 1] : 0);
    return true;
}

/* --- what was printed, as a number --- */

typedef struct Reader {
    const char *at;
    const Net *net;
    Complex s;
    bool failed;
} Reader;

static Complex read_sum(Reader *r);

static void blanks(Reader *r)
{
    while (isspace((unsigned char)*r->at))
        r->at++;
}

static Complex read_atom(Reader *r)
{
    blanks(r);
    if (*r->at == '(') {
        Complex x;

        r->at++;
        x = read_sum(r);
        blanks(r);
        r->failed = r->failed || *r->at != ')';
        r->at += *r->at == ')';
        return x;
    }
    if (*r->at == 's') {
        r->at++;
        return r->s;
    }
    if (*r->at == 'p') {
        char *end;
        const long i = strtol(r->at + 1, &end, 10);

        r->at = end;
        r->failed = r->failed || i >= r->net->count;
        return r->failed ? 0 : r->net->at[i].value;
    }
    if (isdigit((unsigned char)*r->at)) {
        char *end;
        const double x = strtod(r->at, &end);

        r->at = end;
        return x;
    }
    r->failed = true;
    return 0;
}

/* a minus before a power is that of the whole */
static Complex read_power(Reader *r)
{
    Complex x;

    blanks(r);
    if (*r->at == '-') {
        r->at++;
        return -read_power(r);
    }
    x = read_atom(r);
    blanks(r);
    if (*r->at == '^') {
        char *end;
        const long n = strtol(r->at + 1, &end, 10);

        r->at = end;
        return cpow(x, (double)n);
    }
    return x;
}

static Complex read_product(Reader *r)
{
    Complex x = read_power(r);

    for (blanks(r); *r->at == '*' || *r->at == '/'; blanks(r)) {
        const bool divides = *r->at++ == '/';
        const Complex y = read_power(r);

        x = divides ? x / y : x * y;
    }
    return x;
}

static Complex read_sum(Reader *r)
{
    Complex x = 0;

    blanks(r);
    for (bool first = true; first || *r->at == '+' || *r->at == '-'; first = false) {
        const bool minus = *r->at == '-';

        r->at += minus || *r->at == '+';
        x += minus ? -read_product(r) : read_product(r);
        blanks(r);
    }
    return x;
}

/* the ratio of a name ("E/e0"), at s; 0 where nothing is printed of it */
static bool printed_value(const Net *net, const char *text, const char *name, Complex s,
                          Complex *out)
{
    Reader r = {.net = net, .s = s};
    char head[60];
    const char *at;

    (void)snprintf(head, sizeof head, "%s = ", name);
    at = strstr(text, head);
    while (at != NULL && at != text && at[-1] != '\n')
        at = strstr(at + 1, head);
    *out = 0;
    if (at == NULL)
        return true;
    r.at = at + strlen(head);
    *out = read_sum(&r);
    return !r.failed && (*r.at == '\0' || isalpha((unsigned char)*r.at));
}

/* --- members --- */

static const Complex points[] = {0.7 + 0.9 * _Complex_I, -0.3 + 1.7 * _Complex_I, 2.3};

enum { POINTS = sizeof points / sizeof points[0] };

static bool is_source(const Element *e)
{
    return e->kind == V || e->kind == I;
}

/* whether a ratio that was printed is what the oracle finds */
static bool same_ratio(Member *member, const Net *net, const char *text, const char *name, int k,
                       Complex wanted)
{
    Complex got;

    if (!printed_value(net, text, name, points[k], &got)) {
        tell(member, "can't read %s\n", name);
        return false;
    }
    return keeps(member, name, cabs(got - wanted), 1e-7 * (1 + cabs(wanted)));
}

/* Tell what was asked; what has no answer for cotree has none for the oracle. */
static Verdict refused(Member *member, const Net *net, const Kit *kit)
{
    const int node[2] = {1, 0};
    Complex v;

    tell(member, "%s\n%s\n", net->text, kit->error.message);
    return nodal_answer(net, points[0], 0, node, &v) ? REFUSED : AGREES;
}

static Verdict transfer_functions_agree(Member *member)
{
    static Net net;
    Kit kit = kit_new();
    const int node[2] = {1, 0};
    Verdict verdict = AGREES;
    char ask[80];

    draw_net(member, &net);
    write_net(&net);
    (void)snprintf(ask, sizeof ask, "show transfer n1.v e0 symbolic\n");
    if (kit_do(&kit, net.text) != CT_OK || kit_do(&kit, ask) != CT_OK)
        verdict = refused(member, &net, &kit);
    for (int k = 0; verdict == AGREES && kit.text != NULL && k < POINTS; k++) {
        Complex wanted;

        if (!nodal_answer(&net, points[k], 0, node, &wanted))
            verdict = REFUSED;
        else if (!same_ratio(member, &net, kit.text, "n1.v/e0", k, wanted))
            verdict = DISAGREES;
    }
    if (verdict != AGREES || member->told)
        tell(member, "%s%s", net.text, kit.text != NULL ? kit.text : "");
    kit_free(&kit);
    return verdict;
}

/* v = E - Z i and i = J - Y v of one network, between the same terminals */
static bool same_equivalents(Member *member, const Net *net, const int *node, const char *thevenin,
                             const char *norton)
{
    bool same = true;

    for (int k = 0; same && k < POINTS; k++) {
        Complex z;

        if (!nodal_answer(net, points[k], -1, node, &z))
            return true;
        same = thevenin == NULL || same_ratio(member, net, thevenin, "Z", k, z);
        same = same && (norton == NULL || same_ratio(member, net, norton, "Y", k, 1 / z));
        for (int i = 0; same && i < net->count; i++) {
            char name[20];
            Complex e;

            if (!is_source(&net->at[i]) || !nodal_answer(net, points[k], i, node, &e))
                continue;
            (void)snprintf(name, sizeof name, "E/e%d", i);
            same = thevenin == NULL || same_ratio(member, net, thevenin, name, k, e);
            name[0] = 'J';
            same = same && (norton == NULL || same_ratio(member, net, norton, name, k, e / z));
        }
    }
    return same;
}

static Verdict equivalents_agree(Member *member)
{
    static Net net;
    Kit kit = kit_new();
    int node[2];
    char *texts[2] = {NULL, NULL};
    char ask[80], names[2][8];
    Verdict verdict = AGREES;

    draw_net(member, &net);
    write_net(&net);
    do
        for (int k = 0; k < 2; k++)
            node[k] = member_one_of(member, net.nodes + 1);
    while (node[0] == node[1]);
    for (int k = 0; k < 2; k++)
        (void)snprintf(names[k], sizeof names[k], node[k] > 0 ? "n%d" : "0", node[k]);
    if (kit_do(&kit, net.text) != CT_OK)
        verdict = refused(member, &net, &kit);
    for (int k = 0; verdict == AGREES && k < 2; k++) {
        (void)snprintf(ask, sizeof ask, "show %s %s %s\n", k == 0 ? "thevenin" : "norton", names[0],
                       names[1]);
        if (kit_do(&kit, ask) == CT_OK) {
            texts[k] = kit.text;
            kit.text = NULL;
        } else {
            tell(member, "%s%s\n", ask, kit.error.message);
        }
    }
    if (verdict == AGREES && texts[0] == NULL && texts[1] == NULL)
        verdict = refused(member, &net, &kit);
    if (verdict == AGREES && !same_equivalents(member, &net, node, texts[0], texts[1]))
        verdict = DISAGREES;
    if (verdict != AGREES || member->told)
        tell(member, "%s%s%s", net.text, texts[0] != NULL ? texts[0] : "",
             texts[1] != NULL ? texts[1] : "");
    ct_free(texts[0]);
    ct_free(texts[1]);
    kit_free(&kit);
    return verdict;
}

/* --- peaks --- */

enum {
    BRANCHES = 5,
    SCANNED = 400,
    SIDES = 2 * SCANNED + 1,
    SCAN = SCANNED * 5 + BRANCHES * SIDES
};

/* branches of R, L and C between the terminals of a source: Y(s) = sum of s/L/(s^2 + R/L s + 1/LC)
 */
typedef struct Ladder {
    int count;
    double r[BRANCHES], l[BRANCHES], c[BRANCHES];
} Ladder;

/* |Y|, dB, at a frequency, Hz */
static double admittance(const Ladder *n, double f)
{
    const Complex s = 2 * M_PI * f * _Complex_I;
    Complex sum = 0;

    for (int i = 0; i < n->count; i++)
        sum += 1 / (n->r[i] + s * n->l[i] + 1 / (s * n->c[i]));
    return 20 * log10(cabs(sum));
}

static int by_frequency(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* frequencies that are close about each resonance: Hz, SCAN */
static int scan_frequencies(const Ladder *n, double from, double to, double *out)
{
    int count = 0;

    for (int i = 0; i < SCANNED * 5; i++)
        out[count++] = from * pow(to / from, (i + 0.5) / (SCANNED * 5));
    for (int i = 0; i < n->count; i++) {
        const double damping = n->r[i] / (2 * n->l[i]);
        const double f = sqrt(1 / (n->l[i] * n->c[i]) - damping * damping) / (2 * M_PI);

        for (int k = -SCANNED; k <= SCANNED; k++) {
            const double at = f + sinh(k / 40.0) * 0.02 * damping / (2 * M_PI);

            if (at > from && at < to)
                out[count++] = at;
        }
    }
    qsort(out, (size_t)count, sizeof *out, by_frequency);
    return count;
}

/* the top (sign 1) or bottom (-1) between two frequencies, by the golden section */
static double find_extremum(const Ladder *n, double sign, double low, double high)
{
    static const double part = 0.38196601125010515;

    for (int i = 0; i < 100; i++) {
        const double a = low + part * (high - low), b = high - part * (high - low);

        if (sign * admittance(n, a) > sign * admittance(n, b))
            high = b;
        else
            low = a;
    }
    return (low + high) / 2;
}

/* whether a row near the extremum comes to it within 0.1 dB */
static bool is_drawn(Member *member, const Ladder *n, double sign, double f, const double *values,
                     int rows)
{
    const double wanted = admittance(n, f);
    double best = -INFINITY;
    int next = 0;

    while (next < rows - 1 && values[(ptrdiff_t)next * 3] < f)
        next++;
    for (int r = next > 0 ? next - 1 : 0; r <= next; r++)
        best = fmax(best, sign * values[(ptrdiff_t)r * 3 + 1]);
    if (keeps(member, "peak, dB", fabs(sign * wanted - best), 0.1))
        return true;
    tell(member, "at %.12g Hz: %.6g dB, drawn %.6g\n", f, wanted, sign * best);
    return false;
}

static bool peaks_are_drawn(Member *member, const Ladder *n, const double *values, int rows)
{
    static double f[SCAN];
    const int count = scan_frequencies(n, values[0], values[(ptrdiff_t)(rows - 1) * 3], f);
    bool drawn = true;

    for (int i = 1; i + 1 < count && drawn; i++) {
        const double a = admittance(n, f[i - 1]), b = admittance(n, f[i]),
                     c = admittance(n, f[i + 1]);
        const double sign = b > a && b > c ? 1 : b < a && b < c ? -1 : 0;

        /* what the sum of branches rounds away makes bumps, too */
        if (sign == 0 || fmin(fabs(b - a), fabs(b - c)) < 1e-6)
            continue;
        drawn = is_drawn(member, n, sign, find_extremum(n, sign, f[i - 1], f[i + 1]), values, rows);
    }
    return drawn;
}

static void draw_ladder(Member *member, Ladder *n, Net *net)
{
    n->count = 1 + member_one_of(member, BRANCHES);
    net->text[0] = '\0';
    put(net, "vsource E a 0 0\n");
    for (int i = 0; i < n->count; i++) {
        const double omega = member_decades(member, 10, 1e5);
        const double damping = member_decades(member, 1e-6, 0.5); /* ratio */

        n->l[i] = member_decades(member, 1e-3, 1);
        n->c[i] = 1 / (omega * omega * n->l[i]);
        n->r[i] = 2 * damping * omega * n->l[i];
        put(net,
            "resistor R%d a p%d %.17g\ninductor L%d p%d q%d %.17g\ncapacitor C%d q%d 0 %.17g\n", i,
            i, n->r[i], i, i, i, n->l[i], i, i, n->c[i]);
    }
    put(net, "output y = -E.i\nlinearize inputs=[E] outputs=[y]\n");
}

static Verdict peaks_agree(Member *member)
{
    static Net net;
    static const char *const asked[] = {"bode", "bode points=20", "bode points=1000"};
    const char *ask = asked[member_one_of(member, 3)];
    Ladder n;
    Kit kit = kit_new();
    ct_statement *statement = NULL;
    double *values = NULL;
    char **names = NULL;
    int rows = 0, columns = 0;
    Verdict verdict = AGREES;

    draw_ladder(member, &n, &net);
    if (kit_do(&kit, net.text) != CT_OK ||
        ct_parse(&(ct_cursor){.text = ask, .line = 1}, false, &statement, &kit.error) != CT_OK ||
        ct_bode(kit.session, statement, &values, &rows, &columns, &names, &kit.error) != CT_OK)
        verdict = refused(member, &net, &kit);
    else if (!peaks_are_drawn(member, &n, values, rows))
        verdict = DISAGREES;
    if (verdict != AGREES || member->told)
        tell(member, "%s%s\n", net.text, ask);
    ct_statement_free(statement);
    ct_free(values);
    ct_words_free(names);
    kit_free(&kit);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"transfer_functions_agree", 150, 0.1, 0, transfer_functions_agree},
        {"equivalents_agree", 150, 0.1, 0, equivalents_agree},
        {"peaks_agree", 100, 0.1, 0, peaks_agree},
    };

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
