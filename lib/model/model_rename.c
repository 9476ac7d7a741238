/* model_rename.c: a definition's statements in the names of an instance
 *
 * What an instance leg1 makes is called leg1.NAME everywhere in the model, so that no other part of
 * cotree needs to handle subsystems. A name inside is, in this order: a law's argument, a word of
 * the language, a port, a name of its own, a parameter or law of the model. The bare name of a part
 * that is no value means a parameter of that name, the instance's or the model's. */
#include "component/component_rows.h"
#include "language/verbs.h"
#include "model/model_draft.h"

#include <assert.h>
#include <string.h>

typedef struct ModelRenameRenaming {
    State *state;
    int use;
    Pool *pool;
    const Statement *statement; /* a law's arguments hide other names */
    bool gives; /* it belongs to equations: efforts at ports are names of the inside */
    Diag *diag;
    bool along;  /* x is the position along a part */
    bool places; /* names are those of parts, not of values */
} ModelRenameRenaming;

static const Use *use_of(const ModelRenameRenaming *r)
{
    return &r->state->uses.at[r->use];
}

/* "leg1.h2" */
static const char *own_name(const ModelRenameRenaming *r, const char *name)
{
    Text text = {0};
    const char *own;

    text_addf(&text, "%s.%s", use_of(r)->name, name);
    own = pool_text(r->pool, text.at, text.length);
    text_free(&text);
    return own;
}

static bool is_argument(const ModelRenameRenaming *r, const char *name)
{
    for (int i = 0; i < r->statement->argument_count; i++)
        if (strcmp(r->statement->arguments[i], name) == 0)
            return true;
    return r->along && strcmp(name, "x") == 0;
}

static bool is_known(const State *state, const char *name)
{
    return state_thing(state, name) != NULL || names_find(state->terminals, name) >= 0;
}

/* --- ports --- */

/* an arm on ground instead of the frame that a port will be bound to */
static void place_frame(const ModelRenameRenaming *r, const char *name)
{
    State *state = r->state;
    const int outer = state->inside;

    state->inside = r->use;
    (void)part_add(state, &component_arm, name, state->setup.datum[DOMAIN_MECHANICAL], -1, NULL);
    state->inside = outer;
}

/* The node or part that a port is bound to; NULL: it is a name of the inside. A port of a
 * definition that is being read represents whatever it will be bound to. */
static Status port_place(const ModelRenameRenaming *r, int port, const char **out)
{
    const Use *use = use_of(r);
    const char *own = own_name(r, use->subsystem->ports[port].name);
    const char *const *bound = &use->bound[port];

    *out = *bound;
    if (use->is_trial && use->subsystem->ports[port].is_frame && !r->gives &&
        use->subsystem->ports[port].is_through && state_thing(r->state, own) == NULL) {
        (void)diag_at(r->diag, E_NAME, r->statement->place, "nothing before this line makes %s",
                      use->subsystem->ports[port].name);
        diag_hint(r->diag,
                  "arm %s BODY [..] does, and needs no through=", use->subsystem->ports[port].name);
        return E_NAME;
    }
    if (*bound != NULL || !use->is_trial || !use->subsystem->ports[port].is_frame ||
        use->subsystem->ports[port].is_through || state_thing(r->state, own) != NULL)
        return OK;
    own = state_text(r->state, own);
    place_frame(r, own);
    use = use_of(r);
    pool_retain(r->state->pool, &use->bound[port], sizeof *use->bound);
    *out = use->bound[port] = own;
    return OK;
}

/* The potential of a terminal to which nothing is connected yet. */
static void place_terminal(const ModelRenameRenaming *r, const char *name, const char *member)
{
    for (Domain d = DOMAIN_ELECTRICAL; d < DOMAIN_COUNT; d++)
        if (names_find(r->state->terminals, name) < 0 && strcmp(domain_across(d), member) == 0)
            (void)state_terminal(r->state, name, d);
}

/* a member of a frame at rest, or of a terminal without potential, is a number */
static const char *fixed_member(const State *state, bool is_frame, const char *member)
{
    if (!is_frame)
        return "0";
    if (component_find_member(component_find("arm"), state->setup.planar, member) == NULL)
        return NULL;
    return strcmp(member, "q0") == 0 ? "1" : "0";
}

/* --- names --- */

static Status not_seen(const ModelRenameRenaming *r, const char *name, Place place)
{
    const State *state = r->state;
    const char *definition = use_of(r)->subsystem->name;
    Suggest suggest = suggest_for(name);
    Text what = {0};

    if (is_known(state, name)) {
        if (state_thing(state, name) != NULL)
            name_describe(state, state_thing(state, name), &what);
        (void)diag_at(r->diag, E_NAME, place, "%s is %s of the model, which %s doesn't see", name,
                      what.at != NULL ? what.at : "a terminal", definition);
        diag_hint(r->diag,
                  "a subsystem sees the model's parameters and laws; places are given as "
                  "ports: subsystem %s frames=[A] terminals=[e]",
                  definition);
        text_free(&what);
        return E_NAME;
    }
    for (int i = 0; i < names_count(state->names); i++)
        if (name_is_inside(names_get(state->names, i), use_of(r)->name))
            suggest_offer(&suggest, names_get(state->names, i) + strlen(use_of(r)->name) + 1);
    for (int i = 0; i < use_of(r)->subsystem->port_count; i++)
        suggest_offer(&suggest, use_of(r)->subsystem->ports[i].name);
    (void)diag_at(r->diag, E_NAME, place, "unknown name '%s' in %s", name, definition);
    suggest_hint(&suggest, r->diag);
    return E_NAME;
}

static bool is_models(const State *state, const char *name)
{
    return definition_find(state, name, DEFINES_PARAMETER) != NULL ||
           definition_find(state, name, DEFINES_LAW) != NULL;
}

/* whether the bare name, which exists inside, can be that of a value */
static bool is_value(const State *state, const char *name)
{
    const Thing *thing = state_value_thing(state, name);

    return thing != NULL &&
           (thing->kind != THING_PART || part_is_value(state->parts.at[thing->index]));
}

/* `first` is a path's first name, `rest` follows it, with its dot */
static Status path_of_port(const ModelRenameRenaming *r, int port, const char *rest,
                           const char **out, const char **number)
{
    const Port *p = &use_of(r)->subsystem->ports[port];
    const char *place = NULL;
    Text text = {0};

    if (r->gives && given_effort(p, rest) != NULL) {
        text_addf(&text, "%s%s", own_name(r, p->name), given_effort(p, rest));
        *out = pool_text(r->pool, text.at, text.length);
        text_free(&text);
        return OK;
    }
    TRY(port_place(r, port, &place));
    if (place == NULL)
        place = own_name(r, p->name);
    if (!p->is_through && !p->is_frame && rest[0] == '.' && strcmp(place, "0") != 0)
        place_terminal(r, place, rest + 1);
    if (rest[0] == '.' && (strcmp(place, "0") == 0 || strcmp(place, "ground") == 0))
        *number = fixed_member(r->state, p->is_frame, rest + 1);
    text_addf(&text, "%s%s", place, rest);
    *out = pool_text(r->pool, text.at, text.length);
    text_free(&text);
    return OK;
}

/* *number: replaces the name, where it isn't NULL */
static Status rename_path(const ModelRenameRenaming *r, const char *path, Place place,
                          const char **out, const char **number)
{
    const size_t length = strcspn(path, ".");
    const char *first = pool_text(r->pool, path, length);
    const int port = subsystem_port(use_of(r)->subsystem, first);
    const char *own;

    *out = path;
    *number = NULL;
    if (is_argument(r, path) || name_is_reserved(first) || strcmp(first, "0") == 0)
        return OK;
    if (port >= 0)
        return path_of_port(r, port, path + length, out, number);
    own = own_name(r, first);
    if (is_known(r->state, own) && (r->places || path[length] != '\0' || is_value(r->state, own) ||
                                    !is_models(r->state, path))) {
        *out = own_name(r, path);
        return OK;
    }
    return is_models(r->state, path) ? OK : not_seen(r, first, place);
}

/* --- expressions --- */

static Status rename_in(const ModelRenameRenaming *r, Syntax *syntax)
{
    const char *number = NULL;

    if (syntax->kind == SYNTAX_VARIABLE) {
        TRY(rename_path(r, syntax->text, syntax->place, &syntax->text, &number));
        if (number != NULL) {
            syntax->kind = SYNTAX_NUMBER;
            syntax->text = syntax->primes > 0 ? "0" : number;
            syntax->primes = 0;
        }
    }
    /* a call of a law of its own, or of a part's function */
    if (syntax->kind == SYNTAX_CALL &&
        is_known(r->state,
                 own_name(r, pool_text(r->pool, syntax->text, strcspn(syntax->text, ".")))))
        syntax->text = own_name(r, syntax->text);
    for (int i = 0; i < syntax->count; i++)
        TRY(rename_in(r, syntax->args[i]));
    return OK;
}

/* x, -x: letters of axes, not names */
static bool is_axis(const Syntax *syntax)
{
    if (syntax->kind == SYNTAX_UNARY)
        syntax = syntax->args[0];
    return syntax->kind == SYNTAX_VARIABLE && syntax->text[0] >= 'x' && syntax->text[0] <= 'z' &&
           syntax->text[1] == '\0';
}

static Status rename_places(const ModelRenameRenaming *r, Syntax *syntax)
{
    ModelRenameRenaming places = *r;

    places.places = true;
    return rename_in(&places, syntax);
}

static Status rename_value(const ModelRenameRenaming *r, const Param *param, Syntax *syntax)
{
    const ParamKind kind = param != NULL ? param->kind : PARAM_SCALAR;
    ModelRenameRenaming inside = *r;

    if (kind == PARAM_WORD || ((kind == PARAM_AXIS || kind == PARAM_AXES) && is_axis(syntax)))
        return OK;
    for (int i = 0; kind == PARAM_AXES && syntax->kind == SYNTAX_VECTOR && i < syntax->count; i++)
        TRY(rename_value(r, param, syntax->args[i]));
    inside.along = param != NULL && (param->use & ALONG) != 0;
    return kind == PARAM_AXES && syntax->kind == SYNTAX_VECTOR ? OK : rename_in(&inside, syntax);
}

/* a terminal of its own may be new */
static Status rename_terminal(const ModelRenameRenaming *r, Syntax *syntax)
{
    const char *name = syntax_name(syntax);
    const int port = name != NULL ? subsystem_port(use_of(r)->subsystem, name) : -1;
    const char *place = NULL;

    if (name == NULL || strcmp(name, "gnd") == 0 || strcmp(name, "ground") == 0)
        return OK;
    if (strchr(name, '.') != NULL)
        return rename_places(r, syntax);
    if (port >= 0)
        TRY(port_place(r, port, &place));
    syntax->text = place != NULL ? place : own_name(r, name);
    if (strcmp(syntax->text, "0") == 0)
        syntax->kind = SYNTAX_NUMBER;
    return OK;
}

/* a name that the statement makes; several in brackets */
static void rename_new(const ModelRenameRenaming *r, Syntax *syntax)
{
    if (syntax->kind == SYNTAX_VARIABLE)
        syntax->text = own_name(r, syntax->text);
    for (int i = 0; syntax->kind == SYNTAX_VECTOR && i < syntax->count; i++)
        rename_new(r, syntax->args[i]);
}

/* A frame that occurs before the statement that makes it would mean a frame given from outside. */
static Status check_made_first(const ModelRenameRenaming *r, const Operand *name)
{
    const Use *use = use_of(r);
    const int port = subsystem_port(use->subsystem, name->value->text);

    if (port < 0 || use->bound[port] == NULL)
        return OK;
    (void)diag_at(r->diag, E_NAME, name->place,
                  "a line before uses the port %s as one that is given from outside",
                  name->value->text);
    diag_hint(r->diag, "make %s before it is used, or give this another name", name->value->text);
    return E_NAME;
}

/* --- statements --- */

/* number of frames, joints or parts after the name; values may follow them */
static int named_places(const Component *row)
{
    switch (row->places) {
    case PLACES_FROM:
    case PLACES_ON:
    case PLACES_TRANSDUCER:
    case PLACES_JOINT:
        return 1;
    case PLACES_FRAMES:
    case PLACES_JOINTS:
    case PLACES_LINK:
    case PLACES_PARTS:
        return 2;
    default:
        return 0;
    }
}

/* whether place i of a part that acts on joints or on terminals is a terminal */
static bool is_of_terminals(const ModelRenameRenaming *r, const Component *row, int i,
                            const Syntax *value)
{
    const char *name = syntax_name(value);

    return row->variants != NULL && row->places != PLACES_COORDINATE &&
           row->places != PLACES_FRAMES && i > 0 && i <= component_terminals(row) && name != NULL &&
           !state_names_joint(r->state, own_name(r, name));
}

static Status rename_component(const ModelRenameRenaming *r, Statement *s)
{
    const Component *row = s->row.component;
    const int terminals = component_terminals(row), places = named_places(row);
    const int before = row->places == PLACES_TRANSDUCER || row->places == PLACES_SENSED ? 2 : 1;
    const bool has_terminals = before == 2 || row->places == PLACES_TERMINALS;

    for (int i = 0; i < s->operands.count; i++) {
        Syntax *value = s->operands.at[i].value;

        if (i == 0) {
            TRY(check_made_first(r, &s->operands.at[i]));
            rename_new(r, value);
        } else if ((has_terminals && i >= before && i < before + terminals) ||
                   is_of_terminals(r, row, i, value))
            TRY(rename_terminal(r, value));
        else
            TRY(i <= places ? rename_places(r, value) : rename_in(r, value));
    }
    for (int i = 0; i < s->pairs.count; i++) {
        Pair *pair = &s->pairs.at[i];
        const int param = component_param(row, pair->name);
        const char *number;

        if (strcmp(pair->name, "coord") == 0 || strcmp(pair->name, "coords") == 0) {
            rename_new(r, pair->value);
            continue;
        }
        if (row->places == PLACES_COORDINATE && strcmp(pair->name, "by") == 0) {
            TRY(rename_places(r, pair->value));
            continue;
        }
        if (row->places == PLACES_COORDINATE)
            TRY(rename_path(r, pair->name, pair->name_place, &pair->name, &number));
        TRY(rename_value(r, param >= 0 ? &row->params[param] : NULL, pair->value));
    }
    return OK;
}

static Status rename_use(const ModelRenameRenaming *r, Statement *s)
{
    assert(s->operands.at != NULL); /* the grammar requires them */

    const char *name = syntax_name(s->operands.at[0].value);
    const Subsystem *inner = name != NULL ? state_subsystem(r->state, name, NULL) : NULL;

    for (int i = 1; i < s->operands.count; i++)
        rename_new(r, s->operands.at[i].value);
    for (int i = 0; i < s->pairs.count && inner != NULL; i++) {
        Syntax *value = s->pairs.at[i].value;
        const int port = subsystem_port(inner, s->pairs.at[i].name);
        const bool is_terminal = port >= 0 && !inner->ports[port].is_frame;

        if (!is_terminal)
            TRY(port >= 0 ? rename_places(r, value) : rename_in(r, value));
        else if (value->kind != SYNTAX_VECTOR)
            TRY(rename_terminal(r, value));
        for (int k = 0; is_terminal && value->kind == SYNTAX_VECTOR && k < value->count; k++)
            TRY(rename_terminal(r, value->args[k]));
    }
    return OK;
}

/* unknown, internal, give: the ports whose variables a give sets are not renamed */
static Status rename_given(ModelRenameRenaming *r, Statement *s)
{
    r->gives = true;
    for (int i = 0; i < s->operands.count; i++)
        if (s->row.number == VERB_unknown)
            rename_new(r, s->operands.at[i].value);
        else
            TRY(rename_in(r, s->operands.at[i].value));
    for (int i = 0; i < s->pairs.count; i++) {
        const char *path = s->pairs.at[i].name;
        const char *first = pool_text(r->pool, path, strcspn(path, "."));
        const int port = subsystem_port(use_of(r)->subsystem, first);
        const char *place = NULL;

        TRY(rename_in(r, s->pairs.at[i].value));
        if (port >= 0 && given_effort(&use_of(r)->subsystem->ports[port], path + strlen(first)))
            TRY(port_place(r, port, &place));
    }
    return OK;
}

/* operands of a definition's verbs: names and pairs of variables; events also have keys */
static Status rename_verb(const ModelRenameRenaming *r, Statement *s)
{
    const bool is_event = strcmp(s->verb, "event") == 0;
    const bool makes = strcmp(s->verb, "output") == 0;
    const char *number;

    for (int i = 0; i < s->operands.count; i++) {
        Syntax *value = s->operands.at[i].value;

        if (is_event)
            rename_new(r, value);
        else if (value->kind != SYNTAX_VARIABLE || !words_hold(s->row.words, value->text))
            TRY(rename_places(r, value));
    }
    for (int i = 0; i < s->pairs.count; i++) {
        Pair *pair = &s->pairs.at[i];
        const bool is_do = is_event && strcmp(pair->name, "do") == 0;

        if (makes)
            pair->name = own_name(r, pair->name);
        else if (!is_event || (strcmp(pair->name, "when") != 0 && !is_do))
            TRY(rename_path(r, pair->name, pair->name_place, &pair->name, &number));
        if (!is_do)
            TRY(rename_in(r, pair->value));
    }
    return OK;
}

Status statement_rename(State *state, int use, const Statement *statement, Pool *pool,
                        Statement *out, Diag *diag)
{
    ModelRenameRenaming r = {
        .state = state, .use = use, .pool = pool, .statement = statement, .diag = diag};
    Text text = {0};
    Status status = OK;

    statement_copy(pool, statement, out);
    if (statement->kind != STATEMENT_VERB) {
        out->name = own_name(&r, statement->name);
        CHECK(rename_in(&r, out->value));
    } else if (statement->row.component != NULL)
        CHECK(rename_component(&r, out));
    else if (strcmp(statement->verb, "use") == 0)
        CHECK(rename_use(&r, out));
    else if (verb_gives(statement))
        CHECK(rename_given(&r, out));
    else
        CHECK(rename_verb(&r, out));
    statement_print(&text, out);
    out->text = pool_text(pool, text.at, text.length);
done:
    text_free(&text);
    return status;
}
