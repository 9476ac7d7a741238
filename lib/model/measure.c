/* measure.c: dimensions of expressions and variables, from their text
 *
 * A walk over the syntax tree computes a Measure for each node. The bodies of laws are walked with
 * the measures of their arguments; the result for a law is stored during the walk. */
#include "model/model_impl.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    SECOND = 2, /* indices of Dimension.power */
    ANGLE = 5,
    DEEPEST = 4000,  /* depth of nested laws; deeper ones are not walked */
    MOST_LAWS = 5000 /* bodies walked for one statement: laws may call each other twice each */
};

static const Measure any = {.kind = MEASURE_ANY};
static const Measure number = {.kind = MEASURE_NUMBER};
static const Measure ratio = {.kind = MEASURE_RATIO};

/* --- arithmetic --- */

bool measure_same(Measure a, Measure b)
{
    return a.kind == b.kind && memcmp(&a.dimension, &b.dimension, sizeof a.dimension) == 0 &&
           a.has_units == b.has_units && a.has_time == b.has_time && a.is_literal == b.is_literal &&
           a.is_cycles == b.is_cycles;
}

static bool is_angular_rate(Dimension d)
{
    static const Dimension rate = {{0, 0, -1, 0, 0, 1}};

    return memcmp(&d, &rate, sizeof d) == 0;
}

/* 50 Hz is not 50 rad/s */
static bool turns_clash(Measure a, Measure b)
{
    return (a.is_cycles && is_angular_rate(b.dimension)) ||
           (b.is_cycles && is_angular_rate(a.dimension));
}

bool measures_fit(Measure a, Measure b)
{
    if (a.kind != MEASURE_KNOWN || b.kind != MEASURE_KNOWN)
        return true;
    if (turns_clash(a, b))
        return false;
    /* any power of seconds that a bare t omits; without units in the text any power */
    if ((a.has_time || b.has_time) && !a.has_units && !b.has_units)
        return true;
    if (a.has_time || b.has_time)
        a.dimension.power[SECOND] = b.dimension.power[SECOND];
    return dimension_same(a.dimension, b.dimension);
}

/* of a sum of two that match */
static Measure joined(Measure a, Measure b)
{
    if (a.kind == MEASURE_KNOWN && b.kind == MEASURE_KNOWN) {
        const bool same = memcmp(&a.dimension, &b.dimension, sizeof a.dimension) == 0;
        Measure out = a.has_time ? b : a;

        out.has_units = a.has_units || b.has_units;
        out.has_time = out.has_time || (same && (a.has_time || b.has_time)); /* t - 1 s */
        out.is_literal = a.is_literal && b.is_literal && same;
        out.is_cycles = a.is_cycles && b.is_cycles;
        return out;
    }
    if (a.kind == MEASURE_KNOWN || b.kind == MEASURE_KNOWN)
        return a.kind == MEASURE_KNOWN ? a : b;
    if (a.kind == MEASURE_ANY || b.kind == MEASURE_ANY)
        return any;
    return a.kind == MEASURE_RATIO ? b : a;
}

/* a * b, or a / b where `sign` is -1 */
static Measure product(Measure a, Measure b, int sign)
{
    Measure out = {.kind = MEASURE_KNOWN};

    if (a.kind == MEASURE_ANY || b.kind == MEASURE_ANY)
        return any;
    if (a.kind == MEASURE_NUMBER || b.kind == MEASURE_NUMBER)
        return a.kind == MEASURE_KNOWN || b.kind == MEASURE_KNOWN ? any : number;
    if (a.kind == MEASURE_RATIO && b.kind == MEASURE_RATIO)
        return ratio;
    out.has_units = a.has_units || b.has_units;
    out.has_time = a.has_time || b.has_time;
    return dimension_times(a.dimension, b.dimension, sign, &out.dimension) ? out : any;
}

static Measure root(Measure a)
{
    a.is_literal = a.is_cycles = false;
    return a.kind != MEASURE_KNOWN || dimension_root(a.dimension, &a.dimension) ? a : any;
}

static Measure whole_power(Measure a, int power)
{
    static const Dimension none;
    Measure out = a;

    out.is_literal = out.is_cycles = false;
    return dimension_times(none, a.dimension, power, &out.dimension) ? out : any;
}

static bool has_dimension(Measure a)
{
    static const Dimension none;

    return a.kind == MEASURE_KNOWN && !dimension_same(a.dimension, none);
}

static Measure of_unit(const Unit *unit)
{
    return (Measure){.kind = MEASURE_KNOWN,
                     .dimension = unit->dimension,
                     .has_units = true,
                     .is_literal = true,
                     .is_cycles = unit->is_cycles};
}

Measure measure_of_unit(const char *unit)
{
    Unit read;
    size_t fault;
    Measure out = any;

    if (unit != NULL && unit_parse(unit, strlen(unit), &read, &fault)) {
        out.kind = MEASURE_KNOWN;
        out.dimension = read.dimension;
    }
    return out;
}

static Measure rate_of(Measure a, int primes)
{
    static const Dimension second = {{0, 0, 1, 0, 0, 0}};

    if (primes == 0)
        return a;
    a.is_literal = a.is_cycles = false;
    return a.kind == MEASURE_KNOWN && dimension_times(a.dimension, second, -primes, &a.dimension)
               ? a
               : any;
}

/* --- messages where two don't match --- */

bool measure_is_plain(Measure measure)
{
    static const Dimension none;

    return memcmp(&measure.dimension, &none, sizeof none) == 0;
}

void measure_print(Text *text, Measure measure)
{
    if (measure_is_plain(measure))
        text_add(text, "a number");
    else if (measure.is_cycles)
        text_add(text, "Hz");
    else
        dimension_print(text, measure.dimension);
}

void measure_hint(Measure a, Measure b, const char *otherwise, Diag *diag)
{
    diag_hint(diag, "%s",
              turns_clash(a, b) ? "1 Hz is one turn each second: write [rev/s], or [rad/s]"
                                : otherwise);
}

Status measures_join(Measure a, Measure b, const Syntax *left, const Syntax *right,
                     const char *what, Measure *out, Diag *diag)
{
    const Syntax *guilty = a.has_units && !b.has_units ? left : right;
    Text first = {0};
    Text second = {0};

    if (measures_fit(a, b)) {
        *out = joined(a, b);
        return OK;
    }
    measure_print(&first, a);
    measure_print(&second, b);
    (void)diag_at(diag, E_UNIT, guilty->place, "%s and %s can't be %s", first.at, second.at, what);
    if (measure_is_plain(a) || measure_is_plain(b))
        diag_hint(diag, "a quotient that has lost its unit takes another: (...)*1 [%s]",
                  measure_is_plain(a) ? second.at : first.at);
    else
        measure_hint(a, b, SI_HINT, diag);
    text_free(&first);
    text_free(&second);
    return E_UNIT;
}

/* --- the walk --- */

typedef struct LawMeasure { /* of a law, for arguments with these measures */
    int law;
    const Measure *given;
    Measure measure;
} LawMeasure;

typedef struct KnownMeasure {
    Pool *pool; /* of `given`; NULL until the first law */
    LIST(LawMeasure) laws;
    const char *guilty; /* the law that contains a fault; NULL */
} KnownMeasure;

typedef struct MeasureWalk {
    const Scope *scope;
    const Definition *law; /* the law being walked; NULL: the scope's own text */
    const Measure *given;  /* the measures of its arguments */
    int depth;             /* number of syntax tree levels above */
    KnownMeasure *known;
    Diag *diag;
} MeasureWalk;

static Status walk(const MeasureWalk *w, const Syntax *syntax, Measure *out);

/* --- names --- */

static bool find_argument(const MeasureWalk *w, const char *name, Measure *out)
{
    int count = w->law != NULL ? w->law->argument_count : w->scope->argument_count;

    for (int i = 0; i < count; i++) {
        const char *argument =
            w->law != NULL ? expr_name(w->law->arguments[i]) : w->scope->arguments[i];

        if (strcmp(argument, name) == 0) {
            *out = w->law != NULL ? w->given[i] : any;
            return true;
        }
    }
    return false;
}

static const Definition *find_definition(const State *state, const char *name)
{
    const Thing *thing = state_value_thing(state, name);

    return thing != NULL && thing->kind == THING_DEFINITION ? &state->definitions.at[thing->index]
                                                            : NULL;
}

static Measure of_name(const MeasureWalk *w, const Syntax *syntax)
{
    const State *state = w->scope->state;
    const char *name = syntax->text + run_prefix(syntax->text);
    const Definition *d = find_definition(state, name);
    Measure out;

    if (find_argument(w, syntax->text, &out))
        return syntax->primes == 0 ? out : any;
    if (strcmp(name, "t") == 0) {
        out = measure_of_unit("s");
        out.has_time = true;
        return out;
    }
    if (strcmp(name, "pi") == 0)
        return ratio;
    if (d != NULL)
        return rate_of(d->measure, syntax->primes);
    return rate_of(variable_measure(state, w->scope->own, name), syntax->primes);
}

/* --- operators --- */

/* 10 V + t is accepted: an expression of t without units matches a sum, as a number does */
static Measure term(Measure a)
{
    return a.kind == MEASURE_KNOWN && a.has_time && !a.has_units ? number : a;
}

static Status sum(const MeasureWalk *w, const Syntax *syntax, Measure a, Measure b, Measure *out)
{
    const char *what = syntax->text[0] == '+' ? "added" : "subtracted";

    if (!measures_fit(a, b)) {
        a = term(a);
        b = term(b);
    }
    return measures_join(a, b, syntax->args[0], syntax->args[1], what, out, w->diag);
}

/* a power written as a number, in halves */
static bool half_powers(const Syntax *syntax, int *out)
{
    const Syntax *const *args = (const Syntax *const *)syntax->args;
    double value = 0;
    int top = 0;
    int bottom = 0;

    if (syntax->kind == SYNTAX_GROUP && syntax->primes == 0)
        return half_powers(args[0], out);
    if (syntax->kind == SYNTAX_UNARY && syntax->text[0] != '!' && half_powers(args[0], &top)) {
        *out = syntax->text[0] == '-' ? -top : top;
        return true;
    }
    if (syntax->kind == SYNTAX_BINARY && strcmp(syntax->text, "/") == 0 &&
        half_powers(args[0], &top) && half_powers(args[1], &bottom) && bottom != 0 &&
        2 * top % bottom == 0) {
        *out = 2 * top / bottom;
        return true;
    }
    if (syntax->kind != SYNTAX_NUMBER || syntax->has_unit)
        return false;
    value = 2 * strtod(syntax->text, NULL);
    *out = value < 1000 ? (int)value : 1;
    return value < 1000 && floor(value) == value;
}

static Status power(const MeasureWalk *w, const Syntax *syntax, Measure base, Measure exponent,
                    Measure *out)
{
    const Measure plain = {.kind = MEASURE_KNOWN};
    int halves = 0;
    Text text = {0};

    if (exponent.has_units && !measures_fit(exponent, plain)) {
        measure_print(&text, exponent);
        (void)diag_at(w->diag, E_UNIT, syntax->args[1]->place, "a power is a number, not %s",
                      text.at);
        diag_hint(w->diag, SI_HINT);
        text_free(&text);
        return E_UNIT;
    }
    *out = base;
    if (!has_dimension(base))
        out->is_literal = out->is_cycles = false;
    else if (!half_powers(syntax->args[1], &halves))
        *out = any;
    else
        *out = halves % 2 == 0 ? whole_power(base, halves / 2) : root(whole_power(base, halves));
    return OK;
}

static Status binary(const MeasureWalk *w, const Syntax *syntax, Measure *out)
{
    const Syntax *left = syntax->args[0];
    const Syntax *right = syntax->args[1];
    const char *op = syntax->text;
    Measure a = any;
    Measure b = any;

    TRY(walk(w, left, &a));
    TRY(walk(w, right, &b));
    if (strcmp(op, "*") == 0 || strcmp(op, "/") == 0)
        *out = product(a, b, op[0] == '*' ? 1 : -1);
    else if (strcmp(op, "^") == 0)
        TRY(power(w, syntax, a, b, out));
    else if (strcmp(op, "+") == 0 || strcmp(op, "-") == 0)
        TRY(sum(w, syntax, a, b, out));
    else {
        if (strcmp(op, "&&") != 0 && strcmp(op, "||") != 0)
            TRY(measures_join(a, b, left, right, "compared", out, w->diag));
        *out = ratio;
    }
    return OK;
}

/* --- calls --- */

static const struct {
    const char *name;
    const char *rule; /* as in ops.def */
} rules[] = {
#define OP(id, name, args, derivative, c, latex, value, dimension) {name, dimension},
#include "expr/ops.def"
#undef OP
    {"pulse", "txxttttt=x"}, {"pwl", "ttx=x"},     {"table", "...=?"}, {"mean", "xx=x"},
    {"rms", "xx=x"},         {"final", "xx=x"},    {"first", "..=s"},  {"period", "xx=s"},
    {"settling", "xx=s"},    {"spectrum", "xx=x"}, {"d", "xx=x"}};

static const char *find_rule(const char *name)
{
    for (int i = 0; i < COUNT(rules); i++)
        if (strcmp(rules[i].name, name) == 0)
            return rules[i].rule;
    return NULL;
}

/* The letter of argument i: after the last letter, the last two repeat. */
static char rule_letter(const char *rule, int i)
{
    int count = (int)strcspn(rule, "=");

    if (i < count)
        return rule[i];
    return count >= 2 ? rule[count - 2 + (i - count) % 2] : '.';
}

static Status number_argument(const MeasureWalk *w, const Syntax *call, int i, Measure given)
{
    Measure wanted = {.kind = MEASURE_KNOWN};
    Text text = {0};

    if (!given.has_units || measures_fit(given, wanted))
        return OK;
    measure_print(&text, given);
    (void)diag_at(w->diag, E_UNIT, call->args[i]->place, "%s takes a number or an angle, not %s",
                  call->text, text.at);
    diag_hint(w->diag, SI_HINT);
    text_free(&text);
    return E_UNIT;
}

static Measure rule_value(char letter, Measure x)
{
    switch (letter) {
    case 'x':
        return x;
    case 'q':
        return root(x);
    case 'r':
        return ratio;
    case 'a':
        return measure_of_unit("rad");
    case 's':
        return measure_of_unit("s");
    default:
        return any;
    }
}

static Status by_rule(const MeasureWalk *w, const Syntax *call, const char *rule,
                      const Measure *args, Measure *out)
{
    /* the joined measure so far for each letter, and the argument that set it */
    Measure joined[2] = {number, number};
    const Syntax *first[2] = {NULL, NULL};

    for (int i = 0; i < call->count; i++) {
        char letter = rule_letter(rule, i);
        int which = letter == 't';

        if (letter == 'n')
            TRY(number_argument(w, call, i, args[i]));
        if (letter != 'x' && letter != 't')
            continue;
        if (first[which] == NULL) {
            first[which] = call->args[i];
            joined[which] = args[i];
        }
        TRY(measures_join(joined[which], args[i], first[which], call->args[i],
                          "arguments of one kind", &joined[which], w->diag));
    }
    *out = rule_value(strchr(rule, '=')[1], joined[0]);
    return OK;
}

static const LawMeasure *find_law(const KnownMeasure *known, int law, const Measure *given,
                                  int count)
{
    for (int i = 0; i < known->laws.count; i++) {
        const LawMeasure *kept = &known->laws.at[i];
        bool same = kept->law == law;

        for (int k = 0; same && k < count; k++)
            same = measure_same(kept->given[k], given[k]);
        if (same)
            return kept;
    }
    return NULL;
}

/* Reports a fault inside a law at its call, with the name of the law that contains it. */
static Status by_law(const MeasureWalk *w, const Syntax *call, int index, const Measure *args,
                     Measure *out)
{
    const Definition *law = &w->scope->state->definitions.at[index];
    Diag fault = {0};
    MeasureWalk inside = {w->scope, law, NULL, 0, w->known, w->law == NULL ? &fault : w->diag};
    const LawMeasure *kept;
    Measure *given;
    Status status;

    *out = any;
    if (law->kind != DEFINES_LAW || call->count != law->argument_count ||
        w->depth + law->syntax->height > DEEPEST || w->known->laws.count >= MOST_LAWS)
        return OK;
    inside.depth = w->depth + law->syntax->height;
    kept = find_law(w->known, index, args, call->count);
    if (kept != NULL) {
        *out = kept->measure;
        return OK;
    }
    if (w->known->pool == NULL)
        w->known->pool = pool_new(1024);
    given = pool_alloc(w->known->pool, sizeof *given * (size_t)call->count);
    memcpy(given, args, sizeof *given * (size_t)call->count);
    inside.given = given;
    status = walk(&inside, law->syntax, out);
    if (status == OK) {
        LIST_PUSH(w->known->laws, (LawMeasure){index, given, *out});
        return OK;
    }
    if (w->known->guilty == NULL)
        w->known->guilty = law->name;
    if (w->law == NULL) {
        (void)diag_at(w->diag, status, call->place, "in %s: %s", w->known->guilty, fault.message);
        diag_hint(w->diag, "%s", fault.hint);
    }
    return status;
}

/* an entry of what `show` prints, or of a result */
static Measure of_entry(const MeasureWalk *w, const Syntax *call)
{
    const EntryFinder *entries = w->scope->entries;
    Measure out = measure_of_unit(entry_unit(call->text));

    if (out.kind == MEASURE_ANY && entries != NULL && entries->dimension != NULL &&
        entries->dimension(entries->context, call, &out.dimension))
        out.kind = MEASURE_KNOWN;
    return out;
}

/* a beam's quantity at a position, which is a length */
static Status at_place(const MeasureWalk *w, const Syntax *call, const char *unit,
                       const Measure *args, Measure *out)
{
    Text text = {0};

    *out = measure_of_unit(unit);
    if (call->count != 1 || !args[0].has_units || measures_fit(args[0], measure_of_unit("m")))
        return OK;
    measure_print(&text, args[0]);
    (void)diag_at(w->diag, E_UNIT, call->args[0]->place, "%s takes a place in m, not %s",
                  call->text, text.at);
    diag_hint(w->diag, SI_HINT);
    text_free(&text);
    return E_UNIT;
}

static Status call(const MeasureWalk *w, const Syntax *syntax, Measure *out)
{
    const Thing *thing = state_thing(w->scope->state, syntax->text);
    /* d(h)/d(L) is a derivative unless the model has a law d */
    const bool is_law = thing != NULL && thing->kind == THING_DEFINITION &&
                        w->scope->state->definitions.at[thing->index].kind == DEFINES_LAW &&
                        strcmp(syntax->text, "d") == 0;
    const char *rule = is_law ? NULL : find_rule(syntax->text);
    const char *unit = place_unit(w->scope->state, syntax->text + run_prefix(syntax->text));
    Measure *args = NEW_ARRAY(Measure, syntax->count);
    Status status = OK;

    for (int i = 0; i < syntax->count; i++)
        CHECK(walk(w, syntax->args[i], &args[i]));
    *out = of_entry(w, syntax);
    if (rule != NULL)
        CHECK(by_rule(w, syntax, rule, args, out));
    else if (unit != NULL)
        CHECK(at_place(w, syntax, unit, args, out));
    else if (thing != NULL && thing->kind == THING_DEFINITION)
        CHECK(by_law(w, syntax, thing->index, args, out));
    *out = rate_of(*out, syntax->primes);
done:
    mem_free(args);
    return status;
}

/* --- nodes --- */

/* for a vector: the common measure of its entries, which may differ */
static Status vector(const MeasureWalk *w, const Syntax *syntax, Measure *out)
{
    Measure entry = any;
    Measure whole = number;

    for (int i = 0; i < syntax->count; i++) {
        TRY(walk(w, syntax->args[i], &entry));
        whole = i == 0 ? entry : measures_fit(whole, entry) ? joined(whole, entry) : any;
    }
    *out = whole;
    if (syntax->has_unit)
        *out = whole.kind == MEASURE_KNOWN ? product(whole, of_unit(&syntax->unit), 1)
                                           : of_unit(&syntax->unit);
    return OK;
}

static Status walk(const MeasureWalk *w, const Syntax *syntax, Measure *out)
{
    *out = any;
    switch (syntax->kind) {
    case SYNTAX_NUMBER:
        *out = syntax->has_unit ? of_unit(&syntax->unit) : number;
        break;
    case SYNTAX_STRING:
        break;
    case SYNTAX_VARIABLE:
        *out = of_name(w, syntax);
        break;
    case SYNTAX_CALL:
        return call(w, syntax, out);
    case SYNTAX_VECTOR:
        return vector(w, syntax, out);
    case SYNTAX_GROUP:
        TRY(walk(w, syntax->args[0], out));
        *out = rate_of(*out, syntax->primes);
        break;
    case SYNTAX_UNARY:
        TRY(walk(w, syntax->args[0], out));
        if (syntax->text[0] == '!')
            *out = ratio;
        break;
    case SYNTAX_BINARY:
        return binary(w, syntax, out);
    }
    return OK;
}

Status measure_of(const Scope *scope, const Syntax *syntax, Measure *out, Diag *diag)
{
    KnownMeasure known = {0};
    const MeasureWalk w = {scope, NULL, NULL, 0, &known, diag};
    Status status = walk(&w, syntax, out);

    LIST_FREE(known.laws);
    pool_free(known.pool);
    return status;
}

/* --- variables --- */

/* unit of a terminal's potential; NULL: the name is no potential */
static const char *potential_unit(const State *state, const char *name)
{
    const char *dot = strrchr(name, '.');
    char *terminal = mem_text(name, dot != NULL ? (size_t)(dot - name) : 0);
    const char *unit = NULL;

    if (names_find(state->terminals, terminal) >= 0)
        unit = domain_across_unit(terminal_domain(state, terminal));
    mem_free(terminal);
    return unit;
}

/* unit for a joint: along its only coordinate; for a driver: along the one that supplies its
 * motion; for a part that acts on a coordinate, or along a line */
static const char *effort_unit(const State *state, const Instance *part)
{
    static const char *const units[] = {"N", "N*m", NULL, "N*m"};

    if (part->row->family == FAMILY_DRIVER && part->by_coordinate >= 0)
        return units[state->parts.at[part->by]->coord_kind[part->by_coordinate]];
    if (part->row->family != FAMILY_JOINT)
        return part->on_angle ? "N*m" : "N";
    return part->coord_count == 1 ? units[part->coord_kind[0]] : NULL;
}

const char *member_unit(const State *state, const Instance *part, const char *name)
{
    const Member *member = component_find_member(part->row, state->setup.planar, name);

    if (member == NULL)
        return NULL;
    /* the unit of an effort in two parts: on a length, on an angle */
    return strcmp(name, "effort") == 0 ||
                   (member->unit != NULL && strchr(member->unit, '|') != NULL)
               ? effort_unit(state, part)
               : member->unit;
}

Measure variable_measure(const State *state, const Instance *own, const char *name)
{
    static const char *const units[] = {"m", "rad", "1", "rad"};
    const char *member = "";
    const Thing *thing = state_thing(state, name);
    const Instance *part = state_owner(state, name, &member);
    size_t length = own != NULL ? strlen(own->name) : 0;
    Text resolved = {0};
    Measure out = {.kind = MEASURE_ANY};

    if (whole_unit(name) != NULL)
        return measure_of_unit(whole_unit(name));
    if (own != NULL && strncmp(name, own->name, length) == 0 && name[length] == '.')
        return measure_of_unit(member_unit(state, own, name + length + 1));
    /* a member may be a coordinate that the user has renamed */
    if (thing == NULL && part != NULL &&
        variable_resolve(state, NULL, name, 0, 0, (Place){0}, &resolved, NULL) == OK)
        thing = state_thing(state, resolved.at);
    text_free(&resolved);
    if (thing != NULL && thing->kind != THING_DEFINITION) {
        part = state->parts.at[thing->index];
        if (part->given != NULL) /* equations may use any units for it */
            return out;
        if (thing->kind == THING_COORDINATE || part->coord_count == 1)
            out = measure_of_unit(
                units[part->coord_kind[thing->kind == THING_COORDINATE ? thing->coordinate : 0]]);
    } else if (part != NULL)
        out = measure_of_unit(member_unit(state, part, member));
    else if (thing == NULL)
        out = measure_of_unit(potential_unit(state, name));
    return out;
}
