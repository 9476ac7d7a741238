/* import_spice.c: a netlist of SPICE
 *
 * A card is a line and those that go on with it (+); its first letter tells what it is. Words
 * stand between blanks, commas, brackets and equal signs, whatever the case of their letters.
 * Names that a card speaks of have to be there before it: cards are said in the order of their
 * ranks (parameters, elements, what is controlled by currents, switches, initial values). */
#include "export/spice_source.h"

#include <ctype.h>
#include <math.h>
#include <string.h>
#include <strings.h>

typedef struct Card {
    int line;
    int element;              /* row of elements[]; -1: none */
    LIST(const char *) words; /* in the import's pool; "=" is one */
} Card;

typedef struct DeviceModel {
    const char *type; /* lower case */
    const Card *card;
} DeviceModel;

typedef struct ParameterCard {
    const char *name; /* lower case */
    const char *written;
    const char *value;
    int line;
    enum { WAITING, ON_ITS_WAY, SAID } state;
} ParameterCard;

typedef struct Spice {
    Import *import;
    LIST(Card) cards;
    LIST(DeviceModel) models;
    Names *model_names;
    LIST(ParameterCard) parameters;
    Names *parameter_names;
    int depth;         /* of parameters that need others */
    SpiceTimes times;  /* of .tran */
    const Card *tran;  /* NULL: none */
    bool uses_initial; /* uic: it starts from given values, not from an operating point */
    const char *why;   /* the last value could not be read */
    Diag *diag;
} Spice;

static bool is(const char *a, const char *b)
{
    return strcasecmp(a, b) == 0;
}

static const char *lower(Import *import, const char *word)
{
    char *copy = pool_text(import->pool, word, strlen(word));

    for (char *c = copy; *c != '\0'; c++)
        *c = (char)tolower((unsigned char)*c);
    return copy;
}

/* --- cards --- */

/* where a comment begins at the end of a line: `;`, `//`, or ` $` */
static size_t before_comment(const char *line, size_t length)
{
    for (size_t i = 0; i < length; i++)
        if (line[i] == ';' || (line[i] == '/' && i + 1 < length && line[i + 1] == '/') ||
            (line[i] == '$' && (i == 0 || isspace((unsigned char)line[i - 1])) &&
             (i + 1 == length || isspace((unsigned char)line[i + 1]))))
            return i;
    return length;
}

static bool is_between(char c)
{
    return isspace((unsigned char)c) || c == ',' || c == '(' || c == ')' || c == '\0';
}

/* Words of a line join those of the card. An expression in braces or quotes is one. */
static void add_words(Import *import, Card *card, const char *line, size_t length)
{
    for (size_t i = 0; i < length;) {
        const size_t begin = i;
        const char closing = line[i] == '{' ? '}' : line[i] == '\'' || line[i] == '"' ? line[i] : 0;

        if (is_between(line[i])) {
            i++;
            continue;
        }
        if (line[i] == '=') {
            i++;
        } else if (closing != 0) {
            do
                i++;
            while (i < length && line[i] != closing);
            i += i < length;
        } else {
            while (i < length && !is_between(line[i]) && line[i] != '=' && line[i] != '{')
                i++;
        }
        LIST_PUSH(card->words, pool_text(import->pool, line + begin, i - begin));
    }
}

static bool begins(const char *line, size_t length, const char *word)
{
    return length >= strlen(word) && strncasecmp(line, word, strlen(word)) == 0;
}

/* The first line, no card; people often type it behind a "*". */
static void say_title(Import *import, const char *line, size_t length)
{
    while (length > 0 && (*line == '*' || *line == ' ' || *line == '\t')) {
        line++;
        length--;
    }
    import_title(import, 1, pool_text(import->pool, line, length));
}

/* Lines to cards; the first is the title. What stands between .control and .endc are commands. */
static void read_cards(Spice *s, const char *text, size_t length)
{
    Import *import = s->import;
    bool commands = false;
    int number = 0;

    for (size_t at = 0; at < length;) {
        const char *end = memchr(text + at, '\n', length - at);
        const size_t full = end != NULL ? (size_t)(end - (text + at)) : length - at;
        const char *line = text + at;
        size_t size = full;

        number++;
        at += full + 1;
        while (size > 0 && isspace((unsigned char)*line)) {
            line++;
            size--;
        }
        if (number == 1) {
            say_title(import, line, size);
            continue;
        }
        if (size == 0 || *line == '*' || *line == '#')
            continue;
        size = before_comment(line, size);
        if (begins(line, size, ".control") && !commands) {
            import_leave(import, number, false, ".control", "commands of a simulator");
            commands = true;
        } else if (begins(line, size, ".endc")) {
            commands = false;
        } else if (!commands && begins(line, size, ".end") &&
                   (size == 4 || isspace((unsigned char)line[4]))) {
            break;
        } else if (!commands && *line == '+' && s->cards.count > 0) {
            add_words(import, &s->cards.at[s->cards.count - 1], line + 1, size - 1);
        } else if (!commands) {
            LIST_PUSH(s->cards, (Card){.line = number, .element = -1});
            add_words(import, &s->cards.at[s->cards.count - 1], line, size);
            if (s->cards.at[s->cards.count - 1].words.count == 0)
                s->cards.count--;
        }
    }
}

/* --- words of a card --- */

static const char *word(const Card *card, int i)
{
    return i < card->words.count ? card->words.at[i] : "";
}

static bool is_key(const Card *card, int i)
{
    return i + 1 < card->words.count && card->words.at[i + 1][0] == '=';
}

/* value of the key from word `first` on; NULL: it isn't given */
static const char *key(const Card *card, int first, const char *name)
{
    for (int i = first; i + 2 < card->words.count; i++)
        if (is_key(card, i) && is(card->words.at[i], name))
            return card->words.at[i + 2];
    return NULL;
}

static bool value(Spice *s, const char *text, SpiceValue *out)
{
    s->why = NULL;
    return spice_value(s->import, text, out, &s->why);
}

/* a number given in words or `other` */
static bool value_or(Spice *s, const char *text, const char *other, SpiceValue *out)
{
    return value(s, text != NULL && text[0] != '\0' ? text : other, out);
}

static bool is_zero(SpiceValue v)
{
    return v.is_number && v.number == 0;
}

static void leave(Spice *s, const Card *card, const char *why)
{
    import_leave(s->import, card->line, true, card->words.at[0], "%s", why);
}

/* --- names --- */

static const char *node(Spice *s, const char *name)
{
    if (strcmp(name, "0") == 0 || is(name, "gnd"))
        return "0";
    return import_name(s->import, SPICE_NODE, name);
}

static const char *part(Spice *s, const Card *card)
{
    return import_name(s->import, SPICE_PART, card->words.at[0]);
}

/* --- parameters: those that one speaks of come before it --- */

static void find_parameters(Spice *s)
{
    for (int c = 0; c < s->cards.count; c++) {
        const Card *card = &s->cards.at[c];

        if (!is(card->words.at[0], ".param") && !is(card->words.at[0], ".params"))
            continue;
        for (int i = 1; i < card->words.count; i++) {
            const ParameterCard parameter = {.name = lower(s->import, card->words.at[i]),
                                             .written = card->words.at[i],
                                             .value = word(card, i + 2),
                                             .line = card->line};
            int number;

            if (!is_key(card, i) || i + 2 >= card->words.count) {
                import_leave(s->import, card->line, true, card->words.at[i],
                             "a parameter is NAME=VALUE, an expression in braces or quotes");
                break;
            }
            i += 2;
            number = names_add(s->parameter_names, parameter.name);
            if (number == s->parameters.count)
                LIST_PUSH(s->parameters, parameter);
            else
                s->parameters.at[number] = parameter; /* the last one counts */
        }
    }
}

static void say_parameter(void *context, const char *name)
{
    enum { DEEPEST = 500 };
    Spice *s = context;
    const int number = names_find(s->parameter_names, name);
    ParameterCard *parameter = number >= 0 ? &s->parameters.at[number] : NULL;
    SpiceValue v;

    if (parameter == NULL || parameter->state != WAITING || s->depth > DEEPEST)
        return;
    parameter->state = ON_ITS_WAY;
    s->depth++;
    spice_names(parameter->value, say_parameter, s);
    s->depth--;
    parameter->state = SAID;
    if (value(s, parameter->value, &v))
        import_add(s->import, parameter->line, "%s = %s",
                   import_name(s->import, SPICE_PARAMETER, parameter->written), v.alone);
    else
        import_leave(s->import, parameter->line, true, parameter->written, "%s", s->why);
}

/* --- models --- */

static void find_models(Spice *s)
{
    for (int c = 0; c < s->cards.count; c++) {
        const Card *card = &s->cards.at[c];

        if (!is(card->words.at[0], ".model") || card->words.count < 3)
            continue;
        if (names_add(s->model_names, lower(s->import, card->words.at[1])) == s->models.count)
            LIST_PUSH(s->models, (DeviceModel){lower(s->import, card->words.at[2]), card});
    }
}

/* the model of that name and type, or NULL and why */
static const DeviceModel *find_model(Spice *s, const char *name, const char *type)
{
    const int i = names_find(s->model_names, lower(s->import, name));

    if (i >= 0 && strcmp(s->models.at[i].type, type) == 0)
        return &s->models.at[i];
    s->why = i < 0 ? import_text(s->import, "there is no .model %s", name)
                   : import_text(s->import, "its .model %s is of type %s, not %s", name,
                                 s->models.at[i].type, type);
    return NULL;
}

enum { MODEL_KEYS = 3 }; /* the first word of a model that may be a key */

static bool model_value(Spice *s, const DeviceModel *model, const char *name, const char *other,
                        SpiceValue *out)
{
    return value_or(s, key(model->card, MODEL_KEYS, name), other, out);
}

/* keys that do nothing here, said once for each card that has them */
static void say_others(Spice *s, const Card *card, int first, const char *const *known)
{
    Text others = {0};

    for (int i = first; i < card->words.count; i++) {
        bool is_known = false;

        if (!is_key(card, i))
            continue;
        for (int k = 0; known[k] != NULL; k++)
            is_known = is_known || is(card->words.at[i], known[k]);
        if (!is_known)
            text_addf(&others, "%s%s", others.length > 0 ? " " : "", card->words.at[i]);
    }
    if (others.length > 0)
        import_leave(s->import, card->line, false,
                     import_text(s->import, "%s of %s", others.at,
                                 card->words.at[card->words.at[0][0] == '.' ? 1 : 0]),
                     "no part of ours has that");
    text_free(&others);
}

/* --- elements --- */

static void give_initial(Spice *s, int line, const char *variable, SpiceValue v)
{
    import_add(s->import, line, "init %s = %s", variable, v.alone);
}

/* R, C, L: name, two nodes, a value or KEY=value, ic= */
static void two_terminals(Spice *s, const Card *card, const char *verb, const char *letter,
                          const char *state)
{
    const char *const known[] = {letter, "ic",   "m",     "tc",    "tc1",
                                 "tc2",  "temp", "dtemp", "noisy", NULL};
    const char *given = key(card, 3, letter), *initial = key(card, 3, "ic");
    SpiceValue v, ic, m;

    if (given == NULL)
        given = is_key(card, 3) ? "" : word(card, 3);
    if (!value(s, given, &v) || !value_or(s, key(card, 3, "m"), "1", &m)) {
        leave(s, card, given[0] == '\0' ? "it has no value" : s->why);
        return;
    }
    say_others(s, card, 3, known);
    if (!(m.is_number && m.number == 1))
        v.alone = import_text(s->import, "%s%c%s", v.text, verb[0] == 'c' ? '*' : '/', m.text);
    if (!import_add(s->import, card->line, "%s %s %s %s %s", verb, part(s, card),
                    node(s, card->words.at[1]), node(s, card->words.at[2]), v.alone))
        return;
    if (initial == NULL)
        return;
    if (!s->uses_initial)
        import_leave(s->import, card->line, false,
                     import_text(s->import, "ic= of %s", card->words.at[0]),
                     ".tran doesn't say uic");
    else if (value(s, initial, &ic))
        give_initial(s, card->line, import_text(s->import, "%s.%s", part(s, card), state), ic);
    else
        leave(s, card, s->why);
}

static void say_resistor(Spice *s, const Card *card)
{
    two_terminals(s, card, "resistor", "r", "v");
}

static void say_capacitor(Spice *s, const Card *card)
{
    two_terminals(s, card, "capacitor", "c", "v");
}

static void say_inductor(Spice *s, const Card *card)
{
    two_terminals(s, card, "inductor", "l", "i");
}

/* K: pairs of all inductors that it names */
static void say_coupling(Spice *s, const Card *card)
{
    const int last = card->words.count - 1;
    const char *name = part(s, card);
    SpiceValue k;

    if (last < 3 || !value(s, card->words.at[last], &k)) {
        leave(s, card, last < 3 ? "it couples two inductors" : s->why);
        return;
    }
    for (int i = 1; i < last; i++)
        for (int j = i + 1; j < last; j++) {
            const char *a = import_known(s->import, SPICE_PART, card->words.at[i]);
            const char *b = import_known(s->import, SPICE_PART, card->words.at[j]);

            if (a == NULL || b == NULL) {
                leave(s, card, "an inductor that it names isn't there");
                return;
            }
            if (i > 1 || j > 2)
                name = import_name(s->import, SPICE_PART,
                                   import_text(s->import, "%s_%s_%s", card->words.at[0], a, b));
            import_add(s->import, card->line, "coupling %s %s %s k=%s", name, a, b, k.alone);
        }
}

/* E, G: of a voltage */
static void say_by_voltage(Spice *s, const Card *card)
{
    const bool voltage = tolower((unsigned char)card->words.at[0][0]) == 'e';
    SpiceValue gain;

    if (card->words.count != 6 || is_key(card, 3)) {
        leave(s, card, "only a gain of one voltage can be said");
        return;
    }
    if (!value(s, card->words.at[5], &gain)) {
        leave(s, card, s->why);
        return;
    }
    import_add(s->import, card->line, "%s %s %s %s %s %s gain=%s", voltage ? "vcvs" : "vccs",
               part(s, card), node(s, card->words.at[1]), node(s, card->words.at[2]),
               node(s, card->words.at[3]), node(s, card->words.at[4]), gain.alone);
}

/* F, H: of the current through a voltage source */
static void say_by_current(Spice *s, const Card *card)
{
    const bool voltage = tolower((unsigned char)card->words.at[0][0]) == 'h';
    const char *source = import_known(s->import, SPICE_PART, word(card, 3));
    SpiceValue gain;

    if (card->words.count != 5) {
        leave(s, card, "only a gain of one current can be said");
        return;
    }
    if (source == NULL || !value(s, card->words.at[4], &gain)) {
        leave(s, card,
              source != NULL ? s->why
                             : import_text(s->import, "%s isn't there", card->words.at[3]));
        return;
    }
    import_add(s->import, card->line, "%s %s %s %s of=%s.i gain=%s", voltage ? "ccvs" : "cccs",
               part(s, card), node(s, card->words.at[1]), node(s, card->words.at[2]), source,
               gain.alone);
}

/* D: name, two nodes, model, area; a resistance in series makes a node of its own */
static void say_diode(Spice *s, const Card *card)
{
    static const char *const known[] = {"is", "n", "rs", "level", NULL};
    static const char *const keys[] = {"area", "m", NULL};
    const DeviceModel *model = find_model(s, word(card, 3), "d");
    const char *area = key(card, 4, "area");
    const char *plus;
    SpiceValue is, n, rs, by;

    if (area == NULL && !is_key(card, 4) && isdigit((unsigned char)word(card, 4)[0]))
        area = word(card, 4);
    if (model == NULL || !model_value(s, model, "is", "1e-14", &is) ||
        !model_value(s, model, "n", "1", &n) || !model_value(s, model, "rs", "0", &rs) ||
        !value_or(s, area, "1", &by)) {
        leave(s, card, s->why);
        return;
    }
    say_others(s, card, 4, keys);
    say_others(s, model->card, MODEL_KEYS, known);
    plus = node(s, card->words.at[1]);
    if (!(by.is_number && by.number == 1))
        is.alone = import_text(s->import, "%s*%s", is.text, by.text);
    if (!is_zero(rs)) {
        const char *outer = plus;
        const char *own = import_text(s->import, "%s_rs", card->words.at[0]);

        plus =
            import_name(s->import, SPICE_NODE, import_text(s->import, "%s_a", card->words.at[0]));
        import_add(s->import, card->line, "resistor %s %s %s %s/%s",
                   import_name(s->import, SPICE_PART, own), outer, plus, rs.text, by.text);
    }
    import_add(s->import, card->line, "diode %s %s %s Is=%s n=%s", part(s, card), plus,
               node(s, card->words.at[2]), is.alone, n.alone);
}

/* S, W: closed above a threshold of a voltage or of a source's current */
static void say_switch(Spice *s, const Card *card)
{
    const bool current = tolower((unsigned char)card->words.at[0][0]) == 'w';
    const int at = current ? 4 : 5;
    const DeviceModel *model = find_model(s, word(card, at), current ? "csw" : "sw");
    const char *source = import_known(s->import, SPICE_PART, word(card, 3));
    const char *controlled;
    SpiceValue threshold, hysteresis, on, off;

    if (current && source == NULL)
        s->why = import_text(s->import, "%s isn't there", word(card, 3));
    if (model == NULL || (current && source == NULL) ||
        !model_value(s, model, current ? "it" : "vt", "0", &threshold) ||
        !model_value(s, model, current ? "ih" : "vh", "0", &hysteresis) ||
        !model_value(s, model, "ron", "1", &on) || !model_value(s, model, "roff", "1e12", &off)) {
        leave(s, card, s->why);
        return;
    }
    if (!is_zero(hysteresis)) {
        leave(s, card, "a switch with hysteresis has no counterpart");
        return;
    }
    if (current) {
        controlled = import_text(s->import, "%s.i", source);
    } else {
        const char *a = node(s, card->words.at[3]), *b = node(s, card->words.at[4]);

        controlled = strcmp(a, "0") == 0 && strcmp(b, "0") == 0 ? "0"
                     : strcmp(b, "0") == 0                      ? import_text(s->import, "%s.v", a)
                     : strcmp(a, "0") == 0                      ? import_text(s->import, "-%s.v", b)
                                           : import_text(s->import, "%s.v - %s.v", a, b);
    }
    import_add(s->import, card->line, "switch %s %s %s when=%s > %s Ron=%s Roff=%s", part(s, card),
               node(s, card->words.at[1]), node(s, card->words.at[2]), controlled, threshold.text,
               on.alone, off.alone);
}

/* V, I: [DC] value, AC value phase, a function of time; which is what it gives from t = 0 on */
static void say_source(Spice *s, const Card *card)
{
    const char *verb = tolower((unsigned char)card->words.at[0][0]) == 'v' ? "vsource" : "isource";
    const char *constant = "0", *given = NULL; /* over time */
    LIST(SpiceValue) values = {0};
    SpiceTimes times = s->times;
    SpiceValue v;
    int i = 3;

    s->why = NULL;
    while (i < card->words.count && s->why == NULL) {
        const char *name = card->words.at[i];

        if (is(name, "dc")) {
            i++;
        } else if (is(name, "ac") || is(name, "distof1") || is(name, "distof2")) {
            for (i++; i < card->words.count && spice_number(card->words.at[i], &v.number);)
                i++;
            import_leave(s->import, card->line, false,
                         import_text(s->import, "%s of %s", name, card->words.at[0]),
                         "what is an input is said when equations are linearised");
        } else if (spice_is_source(name)) {
            for (i++; i < card->words.count && !is_key(card, i) && !is(card->words.at[i], "ac") &&
                      !is(card->words.at[i], "dc") && value(s, card->words.at[i], &v);
                 i++)
                LIST_PUSH(values, v);
            if (s->why == NULL && key(card, i, "td") != NULL && value(s, key(card, i, "td"), &v))
                times.delay = v;
            if (s->why == NULL && key(card, i, "r") != NULL && value(s, key(card, i, "r"), &v))
                times.repeat = v;
            while (is_key(card, i))
                i += 3;
            if (s->why == NULL)
                (void)spice_source(s->import, name, values.at, values.count, &times, &given,
                                   &s->why);
            values.count = 0;
        } else if (value(s, name, &v)) {
            constant = v.alone;
            i++;
        }
    }
    if (s->why != NULL)
        leave(s, card, s->why);
    else
        import_add(s->import, card->line, "%s %s %s %s %s", verb, part(s, card),
                   node(s, card->words.at[1]), node(s, card->words.at[2]),
                   given != NULL ? given : constant);
    LIST_FREE(values);
}

/* by the first letter; those of a later rank speak of the others */
static const struct {
    char letter;
    int rank;
    int nodes;
    int words; /* that it has at least */
    void (*say)(Spice *s, const Card *card);
} elements[] = {
    {'r', 0, 2, 3, say_resistor},   {'c', 0, 2, 3, say_capacitor},  {'l', 0, 2, 3, say_inductor},
    {'v', 0, 2, 3, say_source},     {'i', 0, 2, 3, say_source},     {'e', 0, 4, 5, say_by_voltage},
    {'g', 0, 4, 5, say_by_voltage}, {'d', 0, 2, 4, say_diode},      {'k', 1, 0, 4, say_coupling},
    {'f', 1, 2, 4, say_by_current}, {'h', 1, 2, 4, say_by_current}, {'s', 2, 4, 6, say_switch},
    {'w', 2, 2, 5, say_switch},
};
enum { RANKS = 3 };

static int element_of(const Card *card)
{
    for (int i = 0; i < COUNT(elements); i++)
        if (elements[i].letter == tolower((unsigned char)card->words.at[0][0]))
            return i;
    return -1;
}

/* All elements have their names before one is said, and before nodes have theirs; what can't be
 * said is none from then on. */
static void name_elements(Spice *s)
{
    for (int c = 0; c < s->cards.count; c++) {
        Card *card = &s->cards.at[c];

        if (card->words.at[0][0] == '.')
            continue;
        card->element = element_of(card);
        if (card->element < 0) {
            leave(s, card, "there is no such element here");
        } else if (card->words.count < elements[card->element].words) {
            leave(s, card, "it is cut short");
            card->element = -1;
        } else if (import_known(s->import, SPICE_PART, card->words.at[0]) != NULL) {
            leave(s, card, "there is another of that name");
            card->element = -1;
        } else {
            (void)part(s, card);
        }
    }
    for (int c = 0; c < s->cards.count; c++) {
        const Card *card = &s->cards.at[c];

        for (int i = 0; card->element >= 0 && i < elements[card->element].nodes; i++)
            (void)node(s, card->words.at[1 + i]);
    }
}

static void say_elements(Spice *s)
{
    for (int rank = 0; rank < RANKS; rank++)
        for (int c = 0; c < s->cards.count; c++) {
            const Card *card = &s->cards.at[c];

            if (card->element >= 0 && elements[card->element].rank == rank)
                elements[card->element].say(s, card);
        }
}

/* --- what begins with a dot --- */

/* .ic v(node)=value: of terminals */
static void say_initial(Spice *s, const Card *card)
{
    for (int i = 1; i < card->words.count; i += 4) {
        const char *name = word(card, i + 1);
        const char *mine = import_known(s->import, SPICE_NODE, name);
        SpiceValue v;

        if (!is(card->words.at[i], "v") || !is_key(card, i + 1) || mine == NULL ||
            !value(s, word(card, i + 3), &v)) {
            import_leave(s->import, card->line, true, card->words.at[0],
                         "%s is no v(NODE)=VALUE of this circuit", card->words.at[i]);
            return;
        }
        give_initial(s, card->line, import_text(s->import, "%s.v", mine), v);
    }
}

/* .tran step stop [from [largest]] [uic] */
static void read_times(Spice *s)
{
    const SpiceValue none = spice_of(s->import, 0);

    s->times = (SpiceTimes){.step = none, .stop = none};
    for (int c = 0; c < s->cards.count; c++) {
        const Card *card = &s->cards.at[c];

        if (!is(card->words.at[0], ".tran"))
            continue;
        s->tran = card;
        if (!value(s, word(card, 1), &s->times.step) || !value(s, word(card, 2), &s->times.stop)) {
            s->times = (SpiceTimes){.step = none, .stop = none};
            s->tran = NULL;
            import_leave(s->import, card->line, false, ".tran", "%s", s->why);
            continue;
        }
        for (int i = 3; i < card->words.count; i++)
            s->uses_initial = s->uses_initial || is(card->words.at[i], "uic");
    }
}

/* what .tran asks for, as statements in comments: an import runs nothing */
static void say_times(Spice *s, bool has_initial)
{
    if (s->tran == NULL)
        return;
    if (!s->uses_initial && !has_initial)
        import_comment(s->import, s->tran->line, "run: equilibrium");
    import_comment(s->import, s->tran->line, "run: simulate %s every=%s", s->times.stop.alone,
                   s->times.step.alone);
}

static Status say_controls(Spice *s)
{
    static const char *const refused[] = {".subckt", ".include", ".inc", ".lib", ".func"};
    static const char *const met[] = {".model", ".param", ".params", ".tran",
                                      ".ic",    ".ends",  ".title"};
    bool has_initial = false;

    for (int c = 0; c < s->cards.count; c++) {
        const Card *card = &s->cards.at[c];
        const char *name = card->words.at[0];
        bool is_met = name[0] != '.';

        for (int i = 0; i < COUNT(refused); i++)
            if (is(name, refused[i]))
                return import_refuse(s->import, card->line, s->diag, "%s %.60s can't be imported",
                                     name, word(card, 1));
        for (int i = 0; i < COUNT(met); i++)
            is_met = is_met || is(name, met[i]);
        if (is(name, ".ic")) {
            say_initial(s, card);
            has_initial = true;
        } else if (!is_met) {
            import_leave(s->import, card->line, false, name, "it is for the simulator");
        }
    }
    say_times(s, has_initial);
    return OK;
}

Status importer_spice(Import *import, const char *text, size_t length, Diag *diag)
{
    Spice s = {.import = import, .diag = diag};
    Status status;

    import->ignores_case = true;
    s.model_names = names_new();
    s.parameter_names = names_new();
    read_cards(&s, text, length);
    read_times(&s);
    find_parameters(&s);
    find_models(&s);
    for (int i = 0; i < s.parameters.count; i++)
        say_parameter(&s, s.parameters.at[i].name);
    name_elements(&s);
    say_elements(&s);
    status = say_controls(&s);
    for (int i = 0; i < s.cards.count; i++)
        LIST_FREE(s.cards.at[i].words);
    LIST_FREE(s.cards);
    LIST_FREE(s.models);
    LIST_FREE(s.parameters);
    names_free(s.model_names);
    names_free(s.parameter_names);
    return status;
}
