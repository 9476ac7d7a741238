/* spice_elements.c: parameters, models and elements of a netlist, or of a .subckt of it, as
 * statements
 *
 * Names that a card refers to have to be defined before it: cards are written in the order of their
 * ranks (elements, current-controlled elements, switches and subcircuit calls). */
#include "export/spice_impl.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

static bool is_zero(SpiceValue v)
{
    return v.is_number && v.number == 0;
}

/* the card's part of the model is left out */
static void leave(Spice *s, const Card *card, const char *why)
{
    import_leave(s->import, card->line, true, card->words.at[0], "%s", why);
}

/* --- names --- */

const char *spice_node(Spice *s, const char *name)
{
    if (strcmp(name, "0") == 0 || spice_is(name, "gnd"))
        return "0";
    return import_name(s->import, SPICE_NODE, name);
}

static const char *name_of_card(Spice *s, const Card *card)
{
    return import_name(s->import, SPICE_PART, card->words.at[0]);
}

/* --- parameters: those that one refers to precede it --- */

/* those of a card, from word `first` on */
void spice_read_parameters(Spice *s, const Card *card, int first)
{
    for (int i = first; i < card->words.count; i += 3) {
        const ParameterCard parameter = {.name = spice_lower(s->import, card->words.at[i]),
                                         .written = card->words.at[i],
                                         .value = card_word(card, i + 2),
                                         .line = card->line};
        int number;

        if (!card_is_key(card, i) || i + 2 >= card->words.count) {
            import_leave(s->import, card->line, true, card->words.at[i],
                         "a parameter is NAME=VALUE, an expression in braces or quotes");
            return;
        }
        number = names_add(s->parameter_names, parameter.name);
        if (number == s->parameters.count)
            LIST_PUSH(s->parameters, parameter);
        else
            s->parameters.at[number] = parameter; /* the last one counts */
    }
}

static void find_parameters(Spice *s)
{
    for (int c = 0; c < s->cards.count; c++) {
        const Card *card = &s->cards.at[c];

        if (spice_is(card->words.at[0], ".param") || spice_is(card->words.at[0], ".params"))
            spice_read_parameters(s, card, 1);
    }
}

static void write_parameter(void *context, const char *name)
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
    spice_names(parameter->value, write_parameter, s);
    s->depth--;
    parameter->state = SAID;
    if (spice_read(s, parameter->value, &v))
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

        if (!spice_is(card->words.at[0], ".model") || card->words.count < 3)
            continue;
        if (names_add(s->model_names, spice_lower(s->import, card->words.at[1])) == s->models.count)
            LIST_PUSH(s->models, (DeviceModel){spice_lower(s->import, card->words.at[2]), card});
    }
}

void spice_write_values(Spice *s)
{
    find_parameters(s);
    find_models(s);
    for (int i = 0; i < s->parameters.count; i++)
        write_parameter(s, s->parameters.at[i].name);
}

/* --- elements --- */

void spice_write_initial(Spice *s, int line, const char *variable, SpiceValue v)
{
    import_add(s->import, line, "init %s = %s", variable, v.alone);
}

/* --- R, C, L --- */

/* Only the model, the value and the second coefficient of tc= may follow the nodes without a key.
 * False: the element is omitted. */
static bool read_positions(Spice *s, const Card *card, const char *type, const DeviceModel **model,
                           const char **value)
{
    int i = 3;

    *model = NULL;
    *value = NULL;
    while (i < card->words.count) {
        const char *word = card->words.at[i];
        double number;

        if (card_is_key(card, i)) {
            i += spice_is(word, "tc") && i + 3 < card->words.count && !card_is_key(card, i + 3) ? 4
                                                                                                : 3;
        } else if (!spice_number(word, &number) && *model == NULL &&
                   (*model = spice_find_model(s, word, type, &s->why)) != NULL) {
            i++;
        } else if (*value == NULL) {
            *value = word;
            i++;
        } else {
            leave(s, card, import_text(s->import, "'%s' of it can't be taken", word));
            return false;
        }
    }
    return true;
}

static const SpiceKey passive_model_keys[] = {
    {"r res cap ind tc1 tc2 tnom t_measured", TAKEN, NULL},
    {"kf af bv_max", WITHOUT_EFFECT, NULL},
    {"rsh", REFUSED_UNLESS_ZERO, "sheet resistance"},
    {"cj", REFUSED_UNLESS_ZERO, "capacitance an area"},
    {NULL, REFUSED, NULL}};

/* R, C, L: name, two nodes, a value and a model or KEY=value, ic= */
static void two_terminals(Spice *s, const Card *card, const char *verb, const char *letter,
                          const char *long_name, const char *state)
{
    const SpiceKey keys[] = {{letter, TAKEN, NULL},
                             {long_name, TAKEN, NULL},
                             {"ic m scale tc tc1 tc2 temp dtemp", TAKEN, NULL},
                             {"noisy noise ac bv_max", WITHOUT_EFFECT, NULL},
                             {"rser", REFUSED_UNLESS_ZERO, "a resistor in series"},
                             {"rpar", REFUSED_UNLESS_ZERO, "a resistor in parallel"},
                             {"cpar", REFUSED_UNLESS_ZERO, "a capacitor in parallel"},
                             {"lser", REFUSED_UNLESS_ZERO, "an inductor in series"},
                             {"w nt", REFUSED, "geometry"},
                             {"tce", REFUSED_UNLESS_ZERO, "exponential in the temperature"},
                             {NULL, REFUSED, NULL}};
    const char *given = card_key(card, 3, letter), *initial = card_key(card, 3, "ic");
    const DeviceModel *model;
    const char *value;
    SpiceValue v, ic, m, scale, factor;

    if (!read_positions(s, card, letter, &model, &value) ||
        !spice_check_keys(s, card, card, 3, keys) ||
        (model != NULL && !spice_check_keys(s, card, model->card, MODEL_KEYS, passive_model_keys)))
        return;
    if (given == NULL)
        given = card_key(card, 3, long_name);
    if (given == NULL)
        given = value;
    if (given == NULL && model != NULL)
        given = card_key(model->card, MODEL_KEYS, letter);
    if (given == NULL && model != NULL)
        given = card_key(model->card, MODEL_KEYS, long_name);
    if (given == NULL || !spice_read(s, given, &v) ||
        !spice_value_or(s, card_key(card, 3, "m"), "1", &m) ||
        !spice_value_or(s, card_key(card, 3, "scale"), "1", &scale) ||
        !spice_temperature_factor(s, card, model, &factor)) {
        leave(s, card, given == NULL ? "it has no value" : s->why);
        return;
    }
    if (!(scale.is_number && scale.number == 1))
        v = spice_times(s, v, scale);
    if (!(factor.is_number && factor.number == 1))
        v = spice_times(s, v, factor);
    if (!(m.is_number && m.number == 1))
        v.alone = import_text(s->import, "%s%c%s", v.text, verb[0] == 'c' ? '*' : '/', m.text);
    if (!import_add(s->import, card->line, "%s %s %s %s %s", verb, name_of_card(s, card),
                    spice_node(s, card->words.at[1]), spice_node(s, card->words.at[2]), v.alone))
        return;
    if (initial == NULL)
        return;
    if (!s->uses_initial)
        import_leave(s->import, card->line, false,
                     import_text(s->import, "ic= of %s", card->words.at[0]),
                     ".tran doesn't say uic");
    else if (spice_read(s, initial, &ic))
        spice_write_initial(s, card->line,
                            import_text(s->import, "%s.%s", name_of_card(s, card), state), ic);
    else
        leave(s, card, s->why);
}

static void write_resistor(Spice *s, const Card *card)
{
    two_terminals(s, card, "resistor", "r", "res", "v");
}

static void write_capacitor(Spice *s, const Card *card)
{
    two_terminals(s, card, "capacitor", "c", "cap", "v");
}

static void write_inductor(Spice *s, const Card *card)
{
    two_terminals(s, card, "inductor", "l", "ind", "i");
}

/* K: pairs of all inductors that it names */
static void write_coupling(Spice *s, const Card *card)
{
    const int last = card->words.count - 1;
    const char *name = name_of_card(s, card);
    SpiceValue k;

    if (last < 3 || !spice_read(s, card->words.at[last], &k)) {
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
static void write_by_voltage(Spice *s, const Card *card)
{
    const bool voltage = tolower((unsigned char)card->words.at[0][0]) == 'e';
    SpiceValue gain;

    if (card->words.count != 6 || card_is_key(card, 3)) {
        leave(s, card, "only a gain of one voltage can be said");
        return;
    }
    if (!spice_read(s, card->words.at[5], &gain)) {
        leave(s, card, s->why);
        return;
    }
    import_add(s->import, card->line, "%s %s %s %s %s %s gain=%s", voltage ? "vcvs" : "vccs",
               name_of_card(s, card), spice_node(s, card->words.at[1]),
               spice_node(s, card->words.at[2]), spice_node(s, card->words.at[3]),
               spice_node(s, card->words.at[4]), gain.alone);
}

/* F, H: of the current through a voltage source */
static void write_by_current(Spice *s, const Card *card)
{
    const bool voltage = tolower((unsigned char)card->words.at[0][0]) == 'h';
    const char *source = import_known(s->import, SPICE_PART, card_word(card, 3));
    SpiceValue gain;

    if (card->words.count != 5) {
        leave(s, card, "only a gain of one current can be said");
        return;
    }
    if (source == NULL || !spice_read(s, card->words.at[4], &gain)) {
        leave(s, card,
              source != NULL ? s->why
                             : import_text(s->import, "%s isn't there", card->words.at[3]));
        return;
    }
    import_add(s->import, card->line, "%s %s %s %s of=%s.i gain=%s", voltage ? "ccvs" : "cccs",
               name_of_card(s, card), spice_node(s, card->words.at[1]),
               spice_node(s, card->words.at[2]), source, gain.alone);
}

static const SpiceKey diode_keys[] = {{"area m temp dtemp", TAKEN, NULL}, {NULL, REFUSED, NULL}};
static const SpiceKey diode_model_keys[] = {
    {"is js n rs eg xti tnom level", TAKEN, NULL},
    {"kf af", WITHOUT_EFFECT, NULL},         /* noise */
    {"vj pb m mj fc", WITHOUT_EFFECT, NULL}, /* of a capacitance that is refused */
    {"ibv nbv", WITHOUT_EFFECT, NULL},       /* of a breakdown that is refused */
    {"bv", REFUSED, "breakdown"},
    {"cjo cj0 cj", REFUSED_UNLESS_ZERO, "junction capacitance"},
    {"tt", REFUSED_UNLESS_ZERO, "transit time"},
    {"ikf ik ikr", REFUSED_UNLESS_ZERO, "high injection"},
    {"isr", REFUSED_UNLESS_ZERO, "recombination current"},
    {"jsw", REFUSED_UNLESS_ZERO, "sidewall current"},
    {"trs1 trs2", REFUSED_UNLESS_ZERO, "rs= over the temperature"},
    {NULL, REFUSED, NULL}};

/* area, which needs no key, times m */
static bool read_area(Spice *s, const Card *card, SpiceValue *out)
{
    const char *area = card_key(card, 4, "area");
    SpiceValue m;

    if (area == NULL && !card_is_key(card, 4) &&
        (isdigit((unsigned char)card_word(card, 4)[0]) || card_word(card, 4)[0] == '{'))
        area = card_word(card, 4);
    if (!spice_value_or(s, area, "1", out) || !spice_value_or(s, card_key(card, 4, "m"), "1", &m))
        return false;
    if (!(m.is_number && m.number == 1))
        *out = spice_times(s, *out, m);
    return true;
}

/* D: name, two nodes, model, area; a resistance in series makes a node of its own */
static void write_diode(Spice *s, const Card *card)
{
    const DeviceModel *model = spice_find_model(s, card_word(card, 3), "d", &s->why);
    const char *plus, *current;
    SpiceValue is, n, rs, by, level;

    if (model != NULL && (!spice_check_keys(s, card, card, 4, diode_keys) ||
                          !spice_check_keys(s, card, model->card, MODEL_KEYS, diode_model_keys)))
        return;
    current = model != NULL && card_key(model->card, MODEL_KEYS, "js") != NULL ? "js" : "is";
    if (model == NULL || !spice_model_value(s, model, current, "1e-14", &is) ||
        !spice_model_value(s, model, "n", "1", &n) ||
        !spice_model_value(s, model, "rs", "0", &rs) ||
        !spice_model_value(s, model, "level", "1", &level) || !read_area(s, card, &by) ||
        !spice_heat_diode(s, card, model, &is, &n)) {
        leave(s, card, s->why);
        return;
    }
    if (!level.is_number || level.number != 1) {
        leave(s, card, "only level=1 of a diode's .model can be taken");
        return;
    }
    plus = spice_node(s, card->words.at[1]);
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
    import_add(s->import, card->line, "diode %s %s %s Is=%s n=%s", name_of_card(s, card), plus,
               spice_node(s, card->words.at[2]), is.alone, n.alone);
}

/* S, W: closed above a threshold of a voltage or of a source's current */
static void write_switch(Spice *s, const Card *card)
{
    static const SpiceKey none[] = {{NULL, REFUSED, NULL}};
    static const SpiceKey by_voltage[] = {{"vt vh ron roff", TAKEN, NULL}, {NULL, REFUSED, NULL}};
    static const SpiceKey by_current[] = {{"it ih ron roff", TAKEN, NULL}, {NULL, REFUSED, NULL}};
    const bool current = tolower((unsigned char)card->words.at[0][0]) == 'w';
    const int at = current ? 4 : 5;
    const DeviceModel *model =
        spice_find_model(s, card_word(card, at), current ? "csw" : "sw", &s->why);
    const char *source = import_known(s->import, SPICE_PART, card_word(card, 3));
    const char *controlled;
    SpiceValue threshold, hysteresis, on, off;

    if (current && source == NULL)
        s->why = import_text(s->import, "%s isn't there", card_word(card, 3));
    if (model == NULL || (current && source == NULL) ||
        !spice_model_value(s, model, current ? "it" : "vt", "0", &threshold) ||
        !spice_model_value(s, model, current ? "ih" : "vh", "0", &hysteresis) ||
        !spice_model_value(s, model, "ron", "1", &on) ||
        !spice_model_value(s, model, "roff", "1e12", &off)) {
        leave(s, card, s->why);
        return;
    }
    if (!spice_check_keys(s, card, card, at + 1, none) ||
        !spice_check_keys(s, card, model->card, MODEL_KEYS, current ? by_current : by_voltage))
        return;
    if (!is_zero(hysteresis)) {
        leave(s, card, "a switch with hysteresis has no counterpart");
        return;
    }
    if (current) {
        controlled = import_text(s->import, "%s.i", source);
    } else {
        const char *a = spice_node(s, card->words.at[3]), *b = spice_node(s, card->words.at[4]);

        controlled = strcmp(a, "0") == 0 && strcmp(b, "0") == 0 ? "0"
                     : strcmp(b, "0") == 0                      ? import_text(s->import, "%s.v", a)
                     : strcmp(a, "0") == 0                      ? import_text(s->import, "-%s.v", b)
                                           : import_text(s->import, "%s.v - %s.v", a, b);
    }
    import_add(s->import, card->line, "switch %s %s %s when=%s > %s Ron=%s Roff=%s",
               name_of_card(s, card), spice_node(s, card->words.at[1]),
               spice_node(s, card->words.at[2]), controlled, threshold.text, on.alone, off.alone);
}

/* V, I: [DC] value, AC value phase, a function of time; which is its value from t = 0 on */
static void write_source(Spice *s, const Card *card)
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

        if (spice_is(name, "dc")) {
            i++;
        } else if (spice_is(name, "ac") || spice_is(name, "distof1") || spice_is(name, "distof2")) {
            for (i++; i < card->words.count && spice_number(card->words.at[i], &v.number);)
                i++;
            import_leave(s->import, card->line, false,
                         import_text(s->import, "%s of %s", name, card->words.at[0]),
                         "what is an input is said when equations are linearised");
        } else if (spice_is_source(name)) {
            for (i++; i < card->words.count && !card_is_key(card, i) &&
                      !spice_is(card->words.at[i], "ac") && !spice_is(card->words.at[i], "dc") &&
                      spice_read(s, card->words.at[i], &v);
                 i++)
                LIST_PUSH(values, v);
            if (s->why == NULL && card_key(card, i, "td") != NULL &&
                spice_read(s, card_key(card, i, "td"), &v))
                times.delay = v;
            if (s->why == NULL && card_key(card, i, "r") != NULL &&
                spice_read(s, card_key(card, i, "r"), &v))
                times.repeat = v;
            for (; s->why == NULL && card_is_key(card, i); i += 3)
                if (!spice_is(name, "pwl") ||
                    (!spice_is(card->words.at[i], "td") && !spice_is(card->words.at[i], "r")))
                    s->why = import_text(s->import, "%s= of it can't be taken", card->words.at[i]);
            if (s->why == NULL)
                (void)spice_source(s->import, name, values.at, values.count, &times, &given,
                                   &s->why);
            values.count = 0;
        } else if (spice_read(s, name, &v)) {
            constant = v.alone;
            i++;
        }
    }
    if (s->why != NULL)
        leave(s, card, s->why);
    else
        import_add(s->import, card->line, "%s %s %s %s %s", verb, name_of_card(s, card),
                   spice_node(s, card->words.at[1]), spice_node(s, card->words.at[2]),
                   given != NULL ? given : constant);
    LIST_FREE(values);
}

/* --- subcircuits --- */

/* the first word from `first` on that is a key, or announces keys; nodes and names end there */
int spice_first_key(const Card *card, int first)
{
    int i = first;

    while (i < card->words.count && !card_is_key(card, i) &&
           !spice_is(card->words.at[i], "params:"))
        i++;
    return i;
}

/* the .subckt that a card X calls, of those inside and around; NULL */
Spice *spice_find_subcircuit(const Spice *s, const Card *card)
{
    const int last = spice_first_key(card, 1) - 1;

    for (; last > 0 && s != NULL; s = s->outer)
        for (int i = 0; i < s->inner.count; i++)
            if (spice_is(card_word(&s->inner.at[i]->head, 1), card->words.at[last]))
                return s->inner.at[i];
    return NULL;
}

int spice_port_count(const Spice *subcircuit)
{
    return spice_first_key(&subcircuit->head, FIRST_PORT) - FIRST_PORT;
}

/* the name of something inside; NULL: not defined there */
static const char *name_inside(Spice *s, Spice *inside, char kind, const char *name)
{
    const char *ours;

    s->import->scope = &inside->scope;
    ours = import_known(s->import, kind, name);
    s->import->scope = s->outer != NULL ? &s->scope : &s->import->whole;
    return ours;
}

/* whether the head of the subcircuit defines the parameter, so that a card may change its value */
static bool has_parameter(const Spice *subcircuit, const char *name)
{
    const Card *head = &subcircuit->head;

    return card_key(head, spice_first_key(head, FIRST_PORT), name) != NULL;
}

/* X: name, nodes, subcircuit, KEY=value */
static void write_use(Spice *s, const Card *card)
{
    const int keys = spice_first_key(card, 1), nodes = keys - 2;
    Spice *subcircuit = spice_find_subcircuit(s, card);
    Text text = {0};
    SpiceValue v;

    if (subcircuit == NULL || nodes != spice_port_count(subcircuit)) {
        leave(s, card,
              subcircuit == NULL
                  ? import_text(s->import, "there is no .subckt %s", card_word(card, keys - 1))
                  : import_text(s->import, "its .subckt %s has another number of nodes: %d, not %d",
                                card->words.at[keys - 1], spice_port_count(subcircuit), nodes));
        return;
    }
    text_addf(&text, "use %s %s", subcircuit->name, name_of_card(s, card));
    for (int i = 0; i < nodes; i++)
        text_addf(&text, " %s=%s",
                  name_inside(s, subcircuit, SPICE_NODE, subcircuit->head.words.at[FIRST_PORT + i]),
                  spice_node(s, card->words.at[1 + i]));
    for (int i = keys + (card_is_key(card, keys) ? 0 : 1); i + 2 < card->words.count; i += 3) {
        const char *name = card->words.at[i];

        if (!card_is_key(card, i) || !has_parameter(subcircuit, name))
            leave(s, card, import_text(s->import, "its .subckt has no parameter %s", name));
        else if (spice_read(s, card->words.at[i + 2], &v))
            text_addf(&text, " %s=%s", name_inside(s, subcircuit, SPICE_PARAMETER, name), v.text);
        else
            leave(s, card, s->why);
    }
    import_add(s->import, card->line, "%s", text.at);
    text_free(&text);
}

/* by the first letter; those of a later rank speak of the others */
static const struct {
    char letter;
    int rank;
    int nodes;
    int words; /* that it has at least */
    void (*say)(Spice *s, const Card *card);
} elements[] = {
    {'r', 0, 2, 3, write_resistor},   {'c', 0, 2, 3, write_capacitor},
    {'l', 0, 2, 3, write_inductor},   {'v', 0, 2, 3, write_source},
    {'i', 0, 2, 3, write_source},     {'e', 0, 4, 5, write_by_voltage},
    {'g', 0, 4, 5, write_by_voltage}, {'d', 0, 2, 4, write_diode},
    {'k', 1, 0, 4, write_coupling},   {'f', 1, 2, 4, write_by_current},
    {'h', 1, 2, 4, write_by_current}, {'s', 2, 4, 6, write_switch},
    {'w', 2, 2, 5, write_switch},     {'x', 0, 0, 2, write_use},
};
enum { RANKS = 3 };

static int element_of(const Card *card)
{
    for (int i = 0; i < COUNT(elements); i++)
        if (elements[i].letter == tolower((unsigned char)card->words.at[0][0]))
            return i;
    return -1;
}

void spice_name_elements(Spice *s)
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
            (void)name_of_card(s, card);
        }
    }
    for (int c = 0; c < s->cards.count; c++) {
        const Card *card = &s->cards.at[c];

        const int nodes = card->element < 0 ? 0
                          : elements[card->element].say == write_use
                              ? spice_first_key(card, 1) - 2
                              : elements[card->element].nodes;

        for (int i = 0; i < nodes; i++)
            (void)spice_node(s, card->words.at[1 + i]);
    }
}

bool spice_node_is_used(const Spice *s, const char *name)
{
    for (int c = 0; c < s->cards.count; c++) {
        const Card *card = &s->cards.at[c];
        int places = card->element < 0 ? 0 : elements[card->element].nodes;

        if (places > 0 && elements[card->element].say == write_switch)
            places = 2; /* the others are read */
        else if (card->element >= 0 && elements[card->element].say == write_use)
            places = spice_first_key(card, 1) - 2;
        for (int i = 0; i < places; i++)
            if (spice_is(card->words.at[1 + i], name))
                return true;
    }
    return false;
}

void spice_write_elements(Spice *s)
{
    for (int rank = 0; rank < RANKS; rank++)
        for (int c = 0; c < s->cards.count; c++) {
            const Card *card = &s->cards.at[c];

            if (card->element >= 0 && elements[card->element].rank == rank)
                elements[card->element].say(s, card);
        }
}
