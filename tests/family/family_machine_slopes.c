/* family_machine_slopes.c: linear equations of machines of several domains, their frequency
 * responses and transfer functions, about moving and resting points
 *
 * Machines are those of machine_draw.h; sources, actuators and numbers of any part are inputs. The
 * oracle takes differences of its own answers (machine_slopes.h), and solves what comes of them in
 * complex numbers. */
#include "machine_inputs.h"

#include <complex.h>
#undef I
#define IMAGINARY _Complex_I

typedef double complex Complex;

/* --- what is told --- */

/* the words between a word that begins a line and the next such word */
static char *told_list(const char *text, const char *begin, const char *end, char *out, size_t room)
{
    const char *from = strstr(text, begin), *to = from != NULL ? strstr(from, end) : NULL;
    size_t length = 0;

    out[0] = '\0';
    for (from = from != NULL ? from + strlen(begin) : NULL; to != NULL && from < to; from++)
        if (!isspace((unsigned char)*from) && length + 1 < room)
            out[length++] = *from;
    out[length] = '\0';
    return out;
}

/* the states that were told; false: one is unknown */
static bool take_states(Member *member, Slopes *s, const char *text)
{
    static char list[4000];
    char *next = told_list(text, "\nstates", "\ninputs", list, sizeof list);

    s->states = s->freedoms = 0;
    while (next != NULL && *next != '\0' && s->states < STATES) {
        StateName *n = &s->state[s->states++];
        char *comma = strchr(next, ',');

        if (comma != NULL)
            *comma = '\0';
        *n = (StateName){.axis = 0};
        (void)snprintf(n->name, sizeof n->name, "%.31s", next);
        if (!is_store(&s->d->m, n) && !is_mechanical(&s->d->m, n)) {
            tell(member, "unknown state %s\n", n->name);
            return false;
        }
        s->freedoms += n->kind != OF_STORE;
        next = comma != NULL ? comma + 1 : NULL;
    }
    return true;
}

/* where the machine is at t, as it is told */
static void take_base(Kit *kit, Slopes *s, const char *at)
{
    Drawn *d = s->d;
    Machine *m = &d->m;
    char text[80], name[32];

    memset(s->z, 0, sizeof s->z);
    for (int j = 0; j < m->bodies; j++) {
        for (int k = 0; k < m->hinge[j].coordinates; k++) {
            const char *word = m->coordinate[m->hinge[j].coordinate + k].name;

            (void)snprintf(text, sizeof text, "%s%s", word, at);
            d->q[j][k] = kit_value(kit, text);
            (void)snprintf(text, sizeof text, "%s'%s", word, at);
            d->rate[j][k] = kit_value(kit, text);
        }
        for (int k = 0; m->hinge[j].kind == SPHERICAL && k < 4; k++) {
            (void)snprintf(text, sizeof text, "j%d.q%d%s", j, k, at);
            d->q[j][k] = kit_value(kit, text);
        }
        for (int k = 0; m->hinge[j].kind == SPHERICAL && k < 3; k++) {
            (void)snprintf(text, sizeof text, "j%d.W%c%s", j, "xyz"[k], at);
            d->rate[j][k] = kit_value(kit, text);
        }
    }
    for (int i = 0; i < m->elements; i++)
        for (int more = 0; more < 2; more++)
            if (store_name(m, i, more, name)) {
                (void)snprintf(text, sizeof text, "%s%s", name, at);
                s->z[more ? m->element[i].more : m->element[i].state] = kit_value(kit, text);
            }
    stand_there(d, &s->base);
    s->base.t = s->t;
    memcpy(s->base.z, s->z, sizeof s->z);
}

static void set_steps(Slopes *s)
{
    for (int i = 0; i < s->states; i++) {
        const StateName *n = &s->state[i];

        s->step[i] = n->kind == OF_STORE ? 1e-3 * (fabs(s->z[n->of]) + 1e-2)
                     : n->is_speed       ? 5e-3
                                         : 5e-4;
    }
    for (int i = 0; i < s->inputs; i++)
        s->step[s->states + i] = s->input[i].step;
}

/* --- entries --- */

/* *smooth: differences are as good as slopes */
static Verdict compare_entries(Member *member, Kit *kit, const Slopes *s, bool *smooth)
{
    int counted = 0, all = 0;

    *smooth = true;
    for (int r = 0; r < s->states + s->outputs; r++) {
        const bool is_output = r >= s->states;
        double most = 0;

        for (int c = 0; c < s->states + s->inputs; c++)
            most = fmax(most, fabs(s->by[r][c]) * s->step[c]);
        for (int c = 0; c < s->states + s->inputs; c++, all++) {
            const bool is_input = c >= s->states;
            const char letter = is_output ? (is_input ? 'D' : 'C') : is_input ? 'B' : 'A';
            const double h = s->step[c], bound = 1e-5 * most + 0.5 * s->gap[r][c] * h +
                                                 1e-9 * fabs(s->size[r]) + 1e-12;
            char text[60];
            double got;

            *smooth = *smooth && s->gap[r][c] * h <= 1e-4 * most + 1e-8 * fabs(s->size[r]) + 1e-11;
            if (s->gap[r][c] * h > 0.005 * most)
                continue; /* it bends too much beside the point, or has a corner there */
            counted++;
            (void)snprintf(text, sizeof text, "linear.%c(%d,%d)", letter,
                           is_output ? r - s->states + 1 : r + 1,
                           is_input ? c - s->states + 1 : c + 1);
            got = kit_value(kit, text);
            if (!keeps(member, text, fabs(got - s->by[r][c]) * h, bound)) {
                tell(member, "%s is %.10g, wanted %.10g, gap %.3g, step %.3g, of %s\n", text, got,
                     s->by[r][c], s->gap[r][c], h,
                     is_input ? s->input[c - s->states].name : s->state[c].name);
                return DISAGREES;
            }
        }
    }
    return counted > all / 2 ? AGREES : REFUSED;
}

/* --- responses --- */

/* Solve in place, by Gauss's method; columns behind the n-th are right sides, and become solutions.
 */
static void solve_complex(int n, int columns, Complex a[STATES][2 * STATES + 1])
{
    for (int c = 0; c < n; c++) {
        int best = c;

        for (int r = c + 1; r < n; r++)
            best = cabs(a[r][c]) > cabs(a[best][c]) ? r : best;
        for (int k = 0; k < columns; k++) {
            const Complex held = a[c][k];

            a[c][k] = a[best][k];
            a[best][k] = held;
        }
        for (int r = c + 1; r < n; r++) {
            const Complex factor = a[r][c] / a[c][c];

            for (int k = c; k < columns; k++)
                a[r][k] -= factor * a[c][k];
        }
    }
    for (int r = n - 1; r >= 0; r--)
        for (int k = n; k < columns; k++) {
            for (int c = r + 1; c < n; c++)
                a[r][k] -= a[r][c] * a[c][k];
            a[r][k] /= a[r][r];
        }
}

/* what differences leave uncertain of a row */
static double row_noise(const Slopes *s, int row)
{
    return 1e-9 + 1e-6 * fabs(s->size[row]);
}

/* C (s - A)^-1 B + D of an input; scale: what its terms are, without their signs, and what they are
 * uncertain by, which a resonance enlarges */
static void respond(const Slopes *s, Complex at, int input, Complex *out, double *scale)
{
    static Complex a[STATES][2 * STATES + 1];
    const int n = s->states;
    double x_sum = 1 / s->step[n + input];

    for (int r = 0; r < n; r++) {
        for (int c = 0; c < n; c++) {
            a[r][c] = (r == c ? at : 0) - s->by[r][c] * s->step[c] / s->step[r];
            a[r][n + 1 + c] = r == c ? 1 : 0;
        }
        a[r][n] = s->by[r][n + input] / s->step[r];
    }
    solve_complex(n, 2 * n + 1, a);
    for (int c = 0; c < n; c++)
        x_sum += cabs(a[c][n]);
    for (int o = 0; o < s->outputs; o++) {
        const double *row = s->by[n + o], noise = row_noise(s, n + o);

        out[o] = row[n + input];
        scale[o] = fabs(row[n + input]) + noise / s->step[n + input];
        for (int c = 0; c < n; c++) {
            double off = 0;

            for (int r = 0; r < n; r++)
                off += cabs(a[c][n + 1 + r]) * row_noise(s, r) / s->step[r] * x_sum;
            out[o] += row[c] * s->step[c] * a[c][n];
            scale[o] += (fabs(row[c] * s->step[c]) + noise) * (cabs(a[c][n]) + off);
        }
    }
}

/* frequency, then gain and phase of each output against each input, a line each */
static Verdict compare_bode(Member *member, Kit *kit, const Slopes *s)
{
    const char *line;
    Complex wanted[INPUTS][OUTPUTS];
    double scale[INPUTS][OUTPUTS];
    const double pi = acos(-1);

    if (do_told(member, kit, "bode from=0.05 to=20 points=7\n") != CT_OK)
        return REFUSED;
    line = strchr(kit->text, '\n');
    for (line = line != NULL ? line + 1 : NULL; line != NULL && *line != '\0';) {
        char *next;
        const double f = strtod(line, &next);

        for (int i = 0; i < s->inputs; i++)
            respond(s, 2 * pi * f * IMAGINARY, i, wanted[i], scale[i]);
        for (int o = 0; o < s->outputs; o++)
            for (int i = 0; i < s->inputs; i++) {
                const double gain = strtod(next + 1, &next), phase = strtod(next + 1, &next);
                const Complex got = pow(10, gain / 20) * cexp(IMAGINARY * pi / 180 * phase);
                const double error = cabs(got - wanted[i][o]);

                if (isnan(gain) && cabs(wanted[i][o]) <= 1e-3 * scale[i][o])
                    continue;
                if (!keeps(member, "response", error, 1e-3 * scale[i][o] + 1e-12)) {
                    tell(member, "at %g Hz, output %d, input %d: %g dB %g deg, wanted %g dB %g\n",
                         f, o, i, gain, phase, 20 * log10(cabs(wanted[i][o])),
                         carg(wanted[i][o]) * 180 / pi);
                    return DISAGREES;
                }
            }
        line = strchr(next, '\n');
        line = line != NULL ? line + 1 : NULL;
    }
    return AGREES;
}

/* coefficients by falling powers, in braces behind a name; how many */
static int take_coefficients(const char *text, const char *name, double *out)
{
    const char *from = strstr(text, name);
    int count = 0;

    from = from != NULL ? strchr(from, '{') : NULL;
    while (from != NULL && *from != '}' && count <= STATES) {
        char *next;

        out[count++] = strtod(from + 1, &next);
        from = next;
    }
    return count;
}

/* and what rounding may leave of it, per unit of last places */
static Complex polynomial(const double *coefficient, int count, Complex s, double *size)
{
    Complex sum = 0;

    *size = 0;
    for (int k = 0; k < count; k++) {
        sum = sum * s + coefficient[k];
        *size = *size * cabs(s) + fabs(coefficient[k]);
    }
    return sum;
}

/* what is told in poles and zeros, at a place, unless one of them is marked */
static Verdict compare_transfer(Member *member, Kit *kit, const Slopes *s, int o, int i, Complex at)
{
    static Complex wanted[OUTPUTS];
    static double scale[OUTPUTS];
    double up[STATES + 2], down[STATES + 2], up_size, down_size;
    Complex above, below;
    char line[60];
    int ups, downs;

    (void)snprintf(line, sizeof line, "show transfer %d %d\n", o + 1, i + 1);
    if (do_told(member, kit, line) != CT_OK)
        return REFUSED;
    if (strchr(kit->text, '?') != NULL)
        return AGREES;
    (void)snprintf(line, sizeof line, "show transfer %d %d as c\n", o + 1, i + 1);
    if (do_told(member, kit, line) != CT_OK)
        return REFUSED;
    ups = take_coefficients(kit->text, "numerator_", up);
    downs = take_coefficients(kit->text, "denominator_", down);
    above = polynomial(up, ups, at, &up_size);
    below = polynomial(down, downs, at, &down_size);
    respond(s, at, i, wanted, scale);
    if (keeps(member, "transfer", cabs(above / below - wanted[o]),
              1e-3 * scale[o] + 1e-12 +
                  1e-9 * (up_size + cabs(above / below) * down_size) / cabs(below)))
        return AGREES;
    tell(member, "output %d, input %d at %g%+gi: %g%+gi, wanted %g%+gi\n%s", o, i, creal(at),
         cimag(at), creal(above / below), cimag(above / below), creal(wanted[o]), cimag(wanted[o]),
         kit->text);
    return DISAGREES;
}

static Verdict compare_transfers(Member *member, Kit *kit, const Slopes *s)
{
    Verdict verdict = AGREES;

    for (int k = 0; k < 4 && verdict == AGREES; k++)
        verdict = compare_transfer(
            member, kit, s, member_one_of(member, s->outputs), member_one_of(member, s->inputs),
            member_between(member, 0, 2) + IMAGINARY * member_decades(member, 0.3, 30));
    return verdict;
}

/* --- members --- */

static void write_order(Slopes *s, Member *member, const char *at, char *line, size_t room)
{
    static Asks asks;
    static Instant now;
    size_t length;

    asks.count = 0;
    memset(&now, 0, sizeof now);
    for (int b = 0; b < BODIES; b++)
        now.R[b] = turn_about(vec(0, 0, 1), 0);
    ask_all(&s->d->m, &now, &asks);
    length = (size_t)snprintf(line, room, "linearize%s inputs=[", at);
    for (int i = 0; i < s->inputs; i++)
        length += (size_t)snprintf(line + length, room - length, "%s%s", i > 0 ? ", " : "",
                                   s->input[i].name);
    length += (size_t)snprintf(line + length, room - length, "] outputs=[");
    for (; s->outputs < OUTPUTS; s->outputs++) {
        s->output[s->outputs] = member_one_of(member, asks.count);
        length += (size_t)snprintf(line + length, room - length, "%s%s", s->outputs > 0 ? ", " : "",
                                   asks.ask[s->output[s->outputs]].text);
    }
    (void)snprintf(line + length, room - length, "]\n");
}

/* what `linearize` tells about t, which the text says as it is written behind a name */
static Verdict linear_at(Member *member, Kit *kit, Slopes *s, double t, const char *at)
{
    char line[1200], key[40] = "";

    s->t = t;
    if (at[0] != '\0')
        (void)snprintf(key, sizeof key, " at=%.17g", t);
    s->outputs = 0;
    write_order(s, member, key, line, sizeof line);
    if (do_told(member, kit, line) != CT_OK || !take_states(member, s, kit->text))
        return REFUSED;
    if (member->told)
        tell(member, "%.3000s\n", kit->text);
    if (strstr(kit->text, "less what jumps") != NULL)
        return REFUSED;
    take_base(kit, s, at);
    set_steps(s);
    if (!slopes_find(s)) {
        tell(member, "no slopes\n");
        return REFUSED;
    }
    {
        bool smooth;
        Verdict verdict = compare_entries(member, kit, s, &smooth);

        if (verdict == AGREES && smooth)
            verdict = compare_bode(member, kit, s);
        return verdict == AGREES && smooth ? compare_transfers(member, kit, s) : verdict;
    }
}

/* About an instant of a run of a machine, its linear equations are what differences tell. */
static Verdict machine_deviates(Member *member)
{
    static Drawn d;
    static Slopes s;
    Kit kit = kit_new();
    const double t = member_between(member, 0.05, 0.3);
    char at[40];
    Verdict verdict = REFUSED;

    while (!draw_machine(member, &d) || (d.m.coordinates == 0 && d.m.states == 0))
        ;
    s = (Slopes){.d = &d};
    draw_inputs(member, &s);
    draw_tree(member, &d, member_one_of(member, 3));
    if (chance(member, 0.2))
        write_line(&d.script, "form embedded");
    write_line(&d.script, "simulate 0.3 every=0.1 rtol=1e-10 atol=1e-12 method=%s",
               draw_method(member));
    (void)snprintf(at, sizeof at, " at %.17g", t);
    if (do_told(member, &kit, d.script.text) == CT_OK)
        verdict = linear_at(member, &kit, &s, t, at);
    kit_free(&kit);
    return verdict;
}

/* Likewise about its rest. */
static Verdict machine_deviates_from_rest(Member *member)
{
    static Drawn d;
    static Slopes s;
    Kit kit = kit_new();
    Verdict verdict = REFUSED;

    still = true;
    while (!draw_machine(member, &d))
        ;
    still = false;
    s = (Slopes){.d = &d};
    draw_inputs(member, &s);
    draw_tree(member, &d, member_one_of(member, 3));
    write_line(&d.script, "equilibrium");
    if (do_told(member, &kit, d.script.text) == CT_OK)
        verdict = linear_at(member, &kit, &s, 0, "");
    kit_free(&kit);
    return verdict;
}

/* Members that went wrong once: a response of exactly 0 at a resonance, which enlarges what
 * differences leave uncertain. */
static Verdict that_failed(Member *member)
{
    member->random = 9913 * 0x9E3779B97F4A7C15U + 13;
    (void)test_random(&member->random);
    return machine_deviates_from_rest(member);
}

static const Family families[] = {
    {"moving machines deviate as differences tell", 25, 0.1, 0, machine_deviates},
    {"resting machines deviate as differences tell", 30, 0.15, 0, machine_deviates_from_rest},
    {"machines that failed once deviate so", 1, 0, 0, that_failed},
};

int main(int argc, char **argv)
{
    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
