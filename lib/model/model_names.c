/* model_names.c: names and their meaning; resolution of dotted names
 *
 * A variable's own name is its coordinate's ("theta1", "m1.x"), or owner and member ("h9.fx"),
 * followed by primes. */
#include "component/equation_block.h"
#include "language/foreign_syntax.h"
#include "language/functions.h"
#include "model/model_impl.h"

#include <ctype.h>
#include <string.h>

/* variables of the whole model; the error has lengths and angles alike */
static const struct {
    const char *name;
    const char *unit;
} model_variables[] = {
    {"energy.kinetic", "J"}, {"energy.potential", "J"}, {"energy.total", "J"},
    {"energy.loss", "W"},    {"energy.lost", "J"},      {"constraint.error", NULL},
    {"model.n", "1"},        {"model.m", "1"},          {"model.dof", "1"}};

/* what count.NAME can count: blocks of equations */
static const char *const blocks[] = {"constraints", "jacobian", "velocity", "acceleration", "mass",
                                     "forces",      "network",  "state",    "equations"};
static const char *const operations[] = {"add", "mul", "fun"};

static bool is_one_of(const char *name, size_t length, const char *const *words, int count)
{
    for (int i = 0; i < count; i++)
        if (strlen(words[i]) == length && strncmp(words[i], name, length) == 0)
            return true;
    return false;
}

size_t run_prefix(const char *path)
{
    size_t length = 3;

    if (strncmp(path, "last.", 5) == 0)
        return 5;
    if (strncmp(path, "run", 3) != 0 || !isdigit((unsigned char)path[3]))
        return 0;
    while (isdigit((unsigned char)path[length]))
        length++;
    return path[length] == '.' ? length + 1 : 0;
}

const char *syntax_name(const Syntax *syntax)
{
    while (syntax != NULL && syntax->kind == SYNTAX_GROUP && syntax->primes == 0)
        syntax = syntax->args[0];
    if (syntax == NULL || syntax->kind != SYNTAX_VARIABLE || syntax->primes > 0)
        return NULL;
    return syntax->text;
}

/* --- descriptions of names --- */

static void article(Text *text, const char *word)
{
    text_addf(text, "%s %s", strchr("aeiou", word[0]) != NULL ? "an" : "a", word);
}

void name_describe(const State *state, const Thing *thing, Text *text)
{
    static const char *const kinds[] = {"parameter", "law", "output", "event", "subsystem"};

    switch (thing->kind) {
    case THING_PART:
        article(text, state->parts.at[thing->index]->row->name);
        break;
    case THING_COORDINATE:
        text_addf(text, "a coordinate of %s", state->parts.at[thing->index]->name);
        break;
    case THING_DEFINITION:
        article(text, kinds[state->definitions.at[thing->index].kind]);
        break;
    case THING_USE:
        text_addf(text, "an instance of %s", state->uses.at[thing->index].subsystem->name);
        break;
    }
}

const char *state_name_at(const State *state, int i)
{
    const Names *const all[] = {state->parameter_names, state->names, state->terminals};

    for (int k = 0; k < COUNT(all); i -= names_count(all[k++]))
        if (i < names_count(all[k]))
            return names_get(all[k], i);
    return NULL;
}

Status name_unknown(const State *state, const char *what, const char *name, Place place, Diag *diag)
{
    Suggest suggest = suggest_for(name);
    const Thing *thing = state_thing(state, name);
    Text kind = {0};
    Function row;
    Unit unit;

    if (thing != NULL) {
        name_describe(state, thing, &kind);
        (void)diag_at(diag, E_NAME, place, "%s is %s, not a %s", name, kind.at, what);
        diag_hint(diag, "'info %s' shows what it has", name);
        text_free(&kind);
        return E_NAME;
    }
    for (int i = 0; state_name_at(state, i) != NULL; i++)
        suggest_offer(&suggest, state_name_at(state, i));
    (void)diag_at(diag, E_NAME, place, "unknown %s '%s'", what, name);
    if (foreign_syntax_hint(FOREIGN_NAME, name) != NULL)
        diag_hint(diag, "%s", foreign_syntax_hint(FOREIGN_NAME, name));
    else if (function_find(name, &row))
        diag_hint(diag, "it is a function, and takes its argument in brackets: %s(x)", name);
    else if (suggest.best == NULL && (unit_find(name, &unit) || unit_spelled(name) != NULL))
        diag_hint(diag, "a unit stands behind a number, 2 m, and a compound one in brackets there: "
                        "2 [N*m], 2 [rad/s]");
    else if (suggest.best != NULL)
        diag_hint(diag, "did you mean '%s'?", suggest.best);
    return E_NAME;
}

static Status check_reserved(const char *name, Place place, Diag *diag)
{
    if (!name_is_reserved(name))
        return OK;
    (void)diag_at(diag, E_NAME, place, "'%s' has a meaning of its own", name);
    diag_hint(diag, "take another name");
    return E_NAME;
}

Status name_is_free(const State *state, const char *name, Place place, Diag *diag)
{
    const Thing *thing = state_thing(state, name);
    Text what = {0};

    TRY(check_reserved(name, place, diag));
    if (thing == NULL)
        return OK;
    name_describe(state, thing, &what);
    (void)diag_at(diag, E_NAME, place, "'%s' is already %s", name, what.at);
    if (thing->kind == THING_PART)
        diag_hint(diag, "delete %s first, or change it with: set %s.KEY = value", name, name);
    else if (thing->kind == THING_DEFINITION || thing->kind == THING_USE)
        diag_hint(diag, "take another name, or: delete %s", name);
    text_free(&what);
    return E_NAME;
}

bool part_is_value(const Instance *part)
{
    return part->row->family == FAMILY_JOINT || instance_is_unknown(part) || part->coord_count == 1;
}

static Status refuse_shared(const char *name, const char *is, const char *other, Place place,
                            Diag *diag)
{
    Text what = {0};

    article(&what, is);
    text_add(&what, ", and ");
    article(&what, other);
    (void)diag_at(diag, E_NAME, place, "'%s' is already %s can't have the same name", name,
                  what.at);
    diag_hint(diag, "in an expression %s could be either; take another name, or: delete %s", name,
              name);
    text_free(&what);
    return E_NAME;
}

Status name_is_free_for_parameter(const State *state, const char *name, Place place, Diag *diag)
{
    const Instance *part = state_part(state, name);

    if (part == NULL)
        return name_is_free(state, name, place, diag);
    return part_is_value(part) ? refuse_shared(name, part->row->name, "parameter", place, diag)
                               : OK;
}

Status part_can_share(const State *state, const Instance *part, Place place, Diag *diag)
{
    return part_is_value(part) && definition_find(state, part->name, DEFINES_PARAMETER) != NULL
               ? refuse_shared(part->name, "parameter", part->row->name, place, diag)
               : OK;
}

/* --- variables --- */

static Status check_order(const char *name, int primes, int most, Place place, Diag *diag)
{
    if (primes <= most)
        return OK;
    (void)diag_at(diag, E_NAME, place, "%s has no derivative of order %d", name, primes);
    if (most == 0)
        diag_hint(diag, "it can be asked for without primes");
    else
        diag_hint(diag, "the highest that can be asked for is %s%s", name, most == 1 ? "'" : "''");
    return E_NAME;
}

/* Reports a part's name without a member where a variable is required: lists its members. */
static Status part_alone(const State *state, const Instance *part, Place place, Diag *diag)
{
    const Member *member = component_member(part->row, state->setup.planar, 0);
    Text list = {0};

    (void)diag_at(diag, E_NAME, place, "%s is no variable: %s has several", part->name, part->name);
    if (part->coord_count == 0 && member == NULL)
        (void)diag_at(diag, E_NAME, place, "%s has no variable", part->name);
    for (int i = 0; i < part->coord_count && i < 3; i++)
        text_addf(&list, "%s%s", i > 0 ? ", " : "", part->coord[i]);
    for (int i = 0; i < 3 && component_member(part->row, state->setup.planar, i) != NULL; i++) {
        member = component_member(part->row, state->setup.planar, i);
        if (part->coord_count > 0 && part->row->family == FAMILY_BODY)
            break;
        text_addf(&list, "%s%s.%s", list.length > 0 ? ", " : "", part->name, member->name);
    }
    if (list.length > 0)
        diag_hint(diag, "ask for one of them: %s ...", list.at);
    text_free(&list);
    return E_NAME;
}

/* hint for a member that is no variable, such as a key or a function of a position */
static void hint_member(const State *state, const Instance *part, const char *member,
                        const Suggest *suggest, const Text *list, Diag *diag)
{
    Text path = {0};

    text_addf(&path, "%s.%s", part->name, member);
    if (place_unit(state, path.at) != NULL)
        diag_hint(diag, "it is asked for at a place along the beam: %s(x)", path.at);
    else if (component_param(part->row, member) >= 0)
        diag_hint(diag,
                  "%s= is one of its keys: 'info %s' shows its value, set %s = ... changes it",
                  member, part->name, path.at);
    else if (suggest->best != NULL)
        diag_hint(diag, "did you mean '%s.%s'?", part->name, suggest->best);
    else if (list->length > 0)
        diag_hint(diag, "it has%s", list->at);
    text_free(&path);
}

static Status member_unknown(const State *state, const Instance *part, const char *member,
                             Place place, Diag *diag)
{
    Suggest suggest = suggest_for(member);
    Text list = {0};
    const Member *m;

    for (int i = 0; i < part->coord_count; i++)
        suggest_offer(&suggest, instance_coord(part, state->setup.planar, i).member);

    for (int i = 0; (m = component_member(part->row, state->setup.planar, i)) != NULL; i++) {
        suggest_offer(&suggest, m->name);
        text_addf(&list, " %s", m->name);
    }
    (void)diag_at(diag, E_NAME, place, "%s %s has no variable '%s'", part->row->name, part->name,
                  member);
    hint_member(state, part, member, &suggest, &list, diag);
    text_free(&list);
    return E_NAME;
}

/* a coordinate by the member name in its row, also where the user renamed it; a part that is being
 * read has none yet */
static int coordinate_of_member(const State *state, const Instance *part, const char *member)
{
    for (int i = 0; i < part->coord_count; i++) {
        const char *own = instance_coord(part, state->setup.planar, i).member;

        if (own[0] != '\0' && strcmp(own, member) == 0)
            return i;
    }
    return -1;
}

static Status member_resolve(const State *state, const Instance *part, const char *member,
                             int primes, Place place, Text *name, Diag *diag)
{
    int coordinate = coordinate_of_member(state, part, member);
    const Member *m = component_find_member(part->row, state->setup.planar, member);

    if (coordinate >= 0) {
        text_add(name, part->coord[coordinate]);
        return check_order(name->at, primes, 2, place, diag);
    }
    if (m != NULL) {
        text_addf(name, "%s.%s", part->name, member);
        return check_order(name->at, primes, m->primes, place, diag);
    }
    return member_unknown(state, part, member, place, diag);
}

static bool is_count(const char *path)
{
    const char *at = path;
    const char *dot;

    if (strncmp(at, "count.", 6) != 0)
        return false;
    at += 6;
    if (strncmp(at, "shared.", 7) == 0)
        at += 7;
    dot = strchr(at, '.');
    return dot != NULL && is_one_of(at, (size_t)(dot - at), blocks, COUNT(blocks)) &&
           is_one_of(dot + 1, strlen(dot + 1), operations, COUNT(operations));
}

static int model_variable(const char *path)
{
    for (int i = 0; i < COUNT(model_variables); i++)
        if (strcmp(model_variables[i].name, path) == 0)
            return i;
    return -1;
}

const char *whole_unit(const char *path)
{
    int variable = model_variable(path);

    return is_count(path) ? "1" : variable >= 0 ? model_variables[variable].unit : NULL;
}

/* energy.total, model.n, count.mass.add */
static Status whole_resolve(const char *path, int primes, unsigned allow, Place place, Text *name,
                            bool *found, Diag *diag)
{
    bool is_known = is_count(path) || model_variable(path) >= 0;
    size_t first = strcspn(path, ".");

    *found = is_known || (path[first] == '.' && word_is_reserved(path, first));
    if (!*found)
        return OK;
    if (!is_known) {
        Suggest suggest = suggest_for(path);

        for (int i = 0; i < COUNT(model_variables); i++)
            suggest_offer(&suggest, model_variables[i].name);
        (void)diag_at(diag, E_NAME, place, "unknown variable '%s'", path);
        suggest_or_hint(&suggest, diag,
                        "such as energy.total, model.n, constraint.error, count.mass.add");
        return E_NAME;
    }
    if (!(allow & ALLOW_MODEL))
        return diag_at(diag, E_NAME, place, "%s can be printed, but nothing can depend on it",
                       path);
    text_add(name, path);
    return check_order(path, primes, 0, place, diag);
}

Domain terminal_domain(const State *state, const char *name)
{
    int number = names_find(state->terminals, name);

    return graph_node(state->graph, state->terminal_nodes.at[number])->domain;
}

static Status plain_resolve(const State *state, const char *path, int primes, Place place,
                            Text *name, Diag *diag)
{
    const Thing *thing = state_thing(state, path);
    const Instance *part;
    Text what = {0};

    if (thing == NULL) {
        if (names_find(state->terminals, path) < 0)
            return name_unknown(state, "name", path, place, diag);
        (void)diag_at(diag, E_NAME, place, "%s is a terminal", path);
        diag_hint(diag, "its potential is %s.%s", path,
                  domain_across(terminal_domain(state, path)));
        return E_NAME;
    }
    part = thing->kind == THING_DEFINITION || thing->kind == THING_USE
               ? NULL
               : state->parts.at[thing->index];
    if (thing->kind == THING_COORDINATE) {
        text_add(name, part->coord[thing->coordinate]);
        return check_order(path, primes, 2, place, diag);
    }
    if (part != NULL && instance_is_unknown(part)) {
        text_add(name, path);
        return check_order(path, primes, part->given->order, place, diag);
    }
    if (part != NULL) {
        if (part->coord_count != 1)
            return part_alone(state, part, place, diag);
        text_add(name, part->coord[0]);
        return check_order(path, primes, 2, place, diag);
    }
    name_describe(state, thing, &what);
    (void)diag_at(diag, E_NAME, place, "%s is %s, no variable", path, what.at);
    if (thing->kind == THING_USE)
        diag_hint(diag, "what is inside is called %s.NAME; 'info %s' lists it", path, path);
    text_free(&what);
    return E_NAME;
}

/* leg1.h3, if there is no such name */
static Status inside_unknown(const State *state, const char *path, const char *use, Place place,
                             Diag *diag)
{
    Suggest suggest = suggest_for(path);

    for (int i = 0; state_name_at(state, i) != NULL; i++)
        if (name_is_inside(state_name_at(state, i), use))
            suggest_offer(&suggest, state_name_at(state, i));
    (void)diag_at(diag, E_NAME, place, "nothing in %s is called %s", use, path + strlen(use) + 1);
    suggest_or_hint(&suggest, diag, "'info %s' lists what is there", use);
    return E_NAME;
}

/* a.v, in other domains a.p, a.w ...: the potential of a terminal */
static Status potential_resolve(const State *state, const char *path, const char *dot, int primes,
                                Place place, Text *name, Diag *diag)
{
    char *terminal = mem_text(path, (size_t)(dot - path));
    const char *across;
    Status status = OK;

    if (state_use(state, terminal) != NULL) {
        status = inside_unknown(state, path, terminal, place, diag);
        goto done;
    }
    if (names_find(state->terminals, terminal) < 0) {
        status = name_unknown(state, "name", terminal, place, diag);
        goto done;
    }
    across = domain_across(terminal_domain(state, terminal));
    if (strcmp(dot + 1, across) != 0) {
        status =
            diag_at(diag, E_NAME, place, "terminal %s has no variable '%s'", terminal, dot + 1);
        diag_hint(diag, "its potential is %s.%s", terminal, across);
        goto done;
    }
    text_add(name, path);
    status = check_order(path, primes, 2, place, diag);
done:
    mem_free(terminal);
    return status;
}

/* a source with zero flow, in one word; none in hydraulics */
static const char *idle_source(Domain domain)
{
    static const char *const sources[DOMAIN_COUNT] = {[DOMAIN_ELECTRICAL] = "isource",
                                                      [DOMAIN_SHAFT] = "torquesource",
                                                      [DOMAIN_SLIDE] = "forcesource",
                                                      [DOMAIN_THERMAL] = "heatsource"};

    return sources[domain];
}

static Status dotted_resolve(const State *state, const Instance *own, const char *path,
                             const char *dot, int primes, Place place, Text *name, Diag *diag)
{
    size_t length = own != NULL ? strlen(own->name) : 0;
    const char *member = NULL;
    const Instance *part = state_owner(state, path, &member);

    if (own != NULL && strncmp(path, own->name, length) == 0 && path[length] == '.') {
        part = own;
        member = path + length + 1;
    }
    Status status;

    if (part != NULL)
        return member_resolve(state, part, member, primes, place, name, diag);
    status = potential_resolve(state, path, dot, primes, place, name, diag);
    /* a loop of blocks, which must be written one after the other */
    if (status == E_NAME && own != NULL && diag != NULL && diag->hint[0] == '\0' &&
        own->row->family == FAMILY_SCALAR && own->row->domain != DOMAIN_HYDRAULIC &&
        strcmp(dot + 1, domain_across(own->row->domain)) == 0)
        diag_hint(diag,
                  "a terminal is known from its first part on: before this line, a source of "
                  "nothing, such as %s I0 %.*s 0 0, brings it",
                  idle_source(own->row->domain), (int)(dot - path), path);
    return status;
}

bool variable_is_integral(const State *state, const char *name)
{
    const char *member = "";
    const Instance *part;

    name += run_prefix(name);
    part = state_owner(state, name, &member);
    return strcmp(name, "energy.lost") == 0 ||
           (part != NULL && part->row->sticks && strcmp(member, "lost") == 0);
}

Status variable_resolve(const State *state, const Instance *own, const char *path, int primes,
                        unsigned allow, Place place, Text *name, Diag *diag)
{
    size_t prefix = run_prefix(path);
    Text rest = {0};
    bool found = false;
    const char *dot;
    Status status = OK;

    if (prefix > 0) {
        if (!(allow & ALLOW_RUNS))
            return diag_at(diag, E_NAME, place, "%s is of a run: nothing can depend on it", path);
        CHECK(variable_resolve(state, own, path + prefix, primes, ALLOW_MODEL, place, &rest, diag));
        text_add_n(name, path, prefix);
        text_add(name, rest.at);
        goto done;
    }
    CHECK(whole_resolve(path, primes, allow, place, name, &found, diag));
    if (found)
        goto done;
    dot = strrchr(path, '.');
    if (dot == NULL || state_thing(state, path) != NULL)
        CHECK(plain_resolve(state, path, primes, place, name, diag));
    else
        CHECK(dotted_resolve(state, own, path, dot, primes, place, name, diag));
    if (!(allow & ALLOW_MODEL) && variable_is_integral(state, path))
        status =
            diag_at(diag, E_NAME, place, "%s can be printed, but nothing can depend on it", path);
done:
    text_free(&rest);
    return status;
}

Status coordinate_resolve(const State *state, const char *path, Place place, int *owner,
                          int *coordinate, Diag *diag)
{
    const Thing *thing;
    Text name = {0};
    const Instance *part;
    Status status = OK;

    CHECK(variable_resolve(state, NULL, path, 0, 0, place, &name, diag));
    thing = state_thing(state, name.at);
    if (thing == NULL || thing->kind == THING_DEFINITION) {
        status = diag_at(diag, E_NAME, place, "%s is no coordinate", path);
        diag_hint(diag, "coordinates are those of joints (h8) and bodies (m1.x)");
        goto done;
    }
    part = state->parts.at[thing->index];
    *owner = part->number;
    *coordinate = thing->kind == THING_COORDINATE ? thing->coordinate : 0;
done:
    text_free(&name);
    return status;
}
