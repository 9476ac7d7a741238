/* import_spice.c: a netlist of SPICE, its subcircuits, and simulator commands
 *
 * A .subckt is a subsystem, with names of its own, and is written before its calls. */
#include "export/spice_impl.h"

#include <ctype.h>
#include <string.h>

/* .ic v(node)=value: of terminals */
static void write_initial(Spice *s, const Card *card)
{
    for (int i = 1; i < card->words.count; i += 4) {
        const char *name = card_word(card, i + 1);
        const char *mine = import_known(s->import, SPICE_NODE, name);
        SpiceValue v;

        if (!spice_is(card->words.at[i], "v") || !card_is_key(card, i + 1) || mine == NULL ||
            !spice_read(s, card_word(card, i + 3), &v)) {
            import_leave(s->import, card->line, true, card->words.at[0],
                         "%s is no v(NODE)=VALUE of this circuit", card->words.at[i]);
            return;
        }
        spice_write_initial(s, card->line, import_text(s->import, "%s.v", mine), v);
    }
}

/* .tran step stop [from [largest]] [uic] */
static void read_times(Spice *s)
{
    const SpiceValue none = spice_of(s->import, 0);

    s->times = (SpiceTimes){.step = none, .stop = none};
    for (int c = 0; c < s->cards.count; c++) {
        const Card *card = &s->cards.at[c];

        if (!spice_is(card->words.at[0], ".tran"))
            continue;
        s->tran = card;
        if (!spice_read(s, card_word(card, 1), &s->times.step) ||
            !spice_read(s, card_word(card, 2), &s->times.stop)) {
            s->times = (SpiceTimes){.step = none, .stop = none};
            s->tran = NULL;
            import_leave(s->import, card->line, false, ".tran", "%s", s->why);
            continue;
        }
        for (int i = 3; i < card->words.count; i++)
            s->uses_initial = s->uses_initial || spice_is(card->words.at[i], "uic");
    }
}

/* the run requested by .tran, as statements in comments: an import runs nothing */
static void write_times(Spice *s, bool has_initial)
{
    if (s->tran == NULL)
        return;
    if (!s->uses_initial && !has_initial)
        import_comment(s->import, s->tran->line, "run: equilibrium");
    import_comment(s->import, s->tran->line, "run: simulate %s every=%s", s->times.stop.alone,
                   s->times.step.alone);
}

/* --- temperatures and options --- */

/* the circuit's temperature, or its tnom, of a card; two that differ are refused */
static void take_temperature(Spice *s, const Card *card, const char *what, const char *text,
                             double *out, bool *is_given)
{
    SpiceValue v;

    if (!spice_read(s, text, &v) || !v.is_number || !(v.number > -273.15))
        import_leave(s->import, card->line, true, card->words.at[0],
                     "%s is no number of degrees Celsius", what);
    else if (*is_given && v.number != *out)
        import_leave(s->import, card->line, true, card->words.at[0],
                     "it gives a second %s: delete one", what);
    else
        *out = v.number;
    *is_given = true;
}

static bool is_options(const Card *card)
{
    return spice_is(card->words.at[0], ".options") || spice_is(card->words.at[0], ".option") ||
           spice_is(card->words.at[0], ".opt");
}

/* .temp T, .options temp=T tnom=T */
static void read_temperatures(Spice *s)
{
    bool has_temperature = false, has_nominal = false;

    s->temperature = s->nominal = 27;
    for (int c = 0; c < s->cards.count; c++) {
        const Card *card = &s->cards.at[c];

        if (spice_is(card->words.at[0], ".temp"))
            for (int i = 1; i < card->words.count || i == 1; i++)
                take_temperature(s, card, "temperature", card_word(card, i), &s->temperature,
                                 &has_temperature);
        for (int i = 1; is_options(card) && i + 2 < card->words.count; i++)
            if (card_is_key(card, i) && spice_is(card->words.at[i], "temp"))
                take_temperature(s, card, "temperature", card->words.at[i + 2], &s->temperature,
                                 &has_temperature);
            else if (card_is_key(card, i) && spice_is(card->words.at[i], "tnom"))
                take_temperature(s, card, "tnom", card->words.at[i + 2], &s->nominal, &has_nominal);
    }
}

/* options that change values are refused; a leakage of gmin = 1 pA a volt is that of our diodes */
static void write_options(Spice *s, const Card *card)
{
    static const char *const refused[] = {"rshunt", "cshunt", "scale", "scalm", "gmin"};
    bool has_others = card->words.count < 2;

    for (int i = 1; i < card->words.count; i += card_is_key(card, i) ? 3 : 1) {
        const char *name = card->words.at[i];
        const bool is_temperature = spice_is(name, "temp") || spice_is(name, "tnom");
        double number;

        has_others = has_others || !is_temperature;
        if (is_temperature && s->outer != NULL)
            import_leave(s->import, card->line, true, card->words.at[0],
                         "%s= stands in a .subckt: move it out", name);
        for (int k = 0; k < COUNT(refused); k++)
            if (spice_is(name, refused[k]) &&
                !(spice_is(name, "gmin") && spice_number(card_word(card, i + 2), &number) &&
                  number == 1e-12))
                import_leave(s->import, card->line, true, card->words.at[0],
                             "%s= isn't modelled; delete it where it has no effect", name);
    }
    if (has_others)
        import_leave(s->import, card->line, false, card->words.at[0], "it is for the simulator");
}

static bool is_for_the_simulator(const char *name)
{
    static const char *const names[] = {
        ".ac",    ".dc",    ".op",      ".noise",    ".tf",    ".sens", ".pz",
        ".disto", ".four",  ".meas",    ".measure",  ".print", ".plot", ".save",
        ".probe", ".width", ".nodeset", ".backanno", ".sp",    ".pss",  ".fourier"};

    for (int i = 0; i < COUNT(names); i++)
        if (spice_is(name, names[i]))
            return true;
    return false;
}

/* a card that isn't met elsewhere */
static void write_control(Spice *s, const Card *card)
{
    const char *name = card->words.at[0];

    if (is_options(card))
        write_options(s, card);
    else if (spice_is(name, ".temp") && s->outer == NULL)
        return; /* read before elements */
    else if (is_for_the_simulator(name))
        import_leave(s->import, card->line, false, name, "it is for the simulator");
    else
        import_leave(s->import, card->line, true, name,
                     "it may change values, and can't be taken; delete it where it has no effect");
}

static Status write_controls(Spice *s)
{
    static const char *const refused[] = {".include", ".inc", ".lib", ".func", ".global"};
    /* where there is no subcircuit, all nodes are global */
    const int refusals = COUNT(refused) - (s->outer == NULL && s->inner.count == 0 ? 1 : 0);
    static const char *const met[] = {".model", ".param", ".params", ".tran", ".ic", ".title"};
    bool has_initial = false;

    for (int c = 0; c < s->cards.count; c++) {
        const Card *card = &s->cards.at[c];
        const char *name = card->words.at[0];
        bool is_met = name[0] != '.';

        for (int i = 0; i < refusals; i++)
            if (spice_is(name, refused[i]))
                return import_refuse(s->import, card->line, s->diag, "%s %.60s can't be imported",
                                     name, card_word(card, 1));
        for (int i = 0; i < COUNT(met); i++)
            is_met = is_met || spice_is(name, met[i]);
        if (spice_is(name, ".ic")) {
            write_initial(s, card);
            has_initial = true;
        } else if (!is_met) {
            write_control(s, card);
        }
    }
    write_times(s, has_initial);
    return OK;
}

/* --- the whole --- */

static Spice *spice_new(Import *import, Spice *outer, Diag *diag)
{
    Spice *s = NEW(Spice);

    s->import = import;
    s->diag = diag;
    s->outer = outer;
    s->model_names = names_new();
    s->parameter_names = names_new();
    return s;
}

static void spice_free(Spice *s)
{
    for (int i = 0; i < s->inner.count; i++)
        spice_free(s->inner.at[i]);
    for (int i = 0; i < s->cards.count; i++)
        LIST_FREE(s->cards.at[i].words);
    LIST_FREE(s->head.words);
    LIST_FREE(s->inner);
    LIST_FREE(s->cards);
    LIST_FREE(s->models);
    LIST_FREE(s->parameters);
    names_free(s->model_names);
    names_free(s->parameter_names);
    if (s->scope.names != NULL)
        import_scope_free(&s->scope);
    mem_free(s);
}

enum { DEEPEST = 50 }; /* subcircuits in one another, or that call one another */

/* cards between .subckt and .ends belong to a subcircuit, the others to the netlist */
static Status part_cards(Spice *whole, Cards *cards)
{
    Spice *s = whole;
    int depth = 0;

    for (int c = 0; c < cards->count; c++) {
        Card *card = &cards->at[c];
        const char *name = card->words.at[0];

        if (spice_is(name, ".subckt")) {
            if (card->words.count < FIRST_PORT || ++depth > DEEPEST)
                return import_refuse(whole->import, card->line, whole->diag,
                                     depth > DEEPEST ? ".subckt in one another, too deep"
                                                     : ".subckt has no name");
            LIST_PUSH(s->inner, spice_new(whole->import, s, whole->diag));
            s = s->inner.at[s->inner.count - 1];
            s->head = *card;
        } else if (spice_is(name, ".ends") && s->outer != NULL) {
            s = s->outer;
            depth--;
            LIST_FREE(card->words);
        } else {
            LIST_PUSH(s->cards, *card);
        }
        *card = (Card){0};
    }
    return s == whole ? OK
                      : import_refuse(whole->import, s->head.line, whole->diag,
                                      ".subckt %.60s has no .ends", s->head.words.at[1]);
}

static Status write_ports(Spice *s)
{
    Text ports = {0};
    Status status = OK;

    for (int i = 0; i < spice_port_count(s) && status == OK; i++) {
        const char *name = s->head.words.at[FIRST_PORT + i];
        const char *mine = import_known(s->import, SPICE_NODE, name);

        if (mine != NULL || strcmp(spice_node(s, name), "0") == 0)
            status = import_refuse(s->import, s->head.line, s->diag,
                                   ".subckt %.60s has the node %.60s %s", s->head.words.at[1], name,
                                   mine != NULL ? "twice" : "among its own, which all have");
        else
            text_addf(&ports, "%s%s", i > 0 ? ", " : "", spice_node(s, name));
    }
    if (status == OK && ports.length > 0)
        import_add(s->import, s->head.line, "subsystem %s terminals=[%s]", s->name, ports.at);
    else if (status == OK)
        import_add(s->import, s->head.line, "subsystem %s", s->name);
    text_free(&ports);
    return status;
}

/* A terminal needs a component: a source of zero current if there is no other. */
static void close_ports(Spice *s)
{
    for (int i = 0; i < spice_port_count(s); i++) {
        const char *name = s->head.words.at[FIRST_PORT + i];

        if (!spice_node_is_used(s, name))
            import_add(s->import, s->head.line, "isource %s %s 0 0",
                       import_name(s->import, SPICE_PART, import_text(s->import, "%s_open", name)),
                       spice_node(s, name));
    }
}

static Status define(Spice *s, int depth);

/* the subcircuits that its cards call are written before it */
static Status define_used(Spice *s, int depth)
{
    Status status = OK;

    for (int c = 0; c < s->cards.count && status == OK; c++) {
        const Card *card = &s->cards.at[c];
        Spice *used = tolower((unsigned char)card->words.at[0][0]) == 'x'
                          ? spice_find_subcircuit(s, card)
                          : NULL;

        if (used != NULL && depth > DEEPEST)
            status = import_refuse(s->import, card->line, s->diag,
                                   "subcircuits call one another too deep");
        else if (used != NULL && used->definition == BEGUN)
            status = import_refuse(s->import, card->line, s->diag,
                                   "%.60s stands in itself: .subckt %.60s", card->words.at[0],
                                   used->head.words.at[1]);
        else if (used != NULL && used->definition == UNSAID)
            status = define(used, depth + 1);
    }
    return status;
}

static Status define(Spice *s, int depth)
{
    const Spice *whole = s->outer;
    const char *around = "";
    Status status = OK;

    while (whole->outer != NULL) {
        around = import_text(s->import, "%s_%s", whole->head.words.at[1], around);
        whole = whole->outer;
    }
    s->definition = BEGUN;
    s->times = whole->times;
    s->uses_initial = whole->uses_initial;
    s->temperature = whole->temperature;
    s->nominal = whole->nominal;
    s->name = import_name(s->import, SPICE_SUBCIRCUIT,
                          import_text(s->import, "%s%s", around, s->head.words.at[1]));
    CHECK(define_used(s, depth));
    import_enter(s->import, &s->scope);
    CHECK(write_ports(s));
    spice_read_parameters(
        s, &s->head,
        spice_first_key(&s->head, FIRST_PORT) +
            (card_is_key(&s->head, spice_first_key(&s->head, FIRST_PORT)) ? 0 : 1));
    spice_write_values(s);
    spice_name_elements(s);
    close_ports(s);
    spice_write_elements(s);
    CHECK(write_controls(s));
    import_add(s->import, s->head.line, "end");
    s->definition = DEFINED;
done:
    import_return(s->import);
    return status;
}

static Status write_netlist(Spice *s)
{
    Status status = OK;

    read_times(s);
    spice_write_values(s);
    read_temperatures(s);
    CHECK(define_used(s, 0));
    for (int i = 0; i < s->inner.count; i++)
        if (s->inner.at[i]->definition == UNSAID)
            import_leave(s->import, s->inner.at[i]->head.line, false,
                         import_text(s->import, ".subckt %s", s->inner.at[i]->head.words.at[1]),
                         "nothing uses it");
    spice_name_elements(s);
    spice_write_elements(s);
    CHECK(write_controls(s));
done:
    return status;
}

Status importer_spice(Import *import, const char *text, size_t length, Diag *diag)
{
    Spice *s = spice_new(import, NULL, diag);
    Cards cards = {0};
    Status status = OK;

    import->ignores_case = true;
    cards_read(import, text, length, &cards);
    CHECK(part_cards(s, &cards));
    CHECK(write_netlist(s));
done:
    for (int i = 0; i < cards.count; i++)
        LIST_FREE(cards.at[i].words);
    LIST_FREE(cards);
    spice_free(s);
    return status;
}
