/* network.c: scalar domains: unknowns by the tree, every other variable along it
 *
 * Every chord starts with its through variable as unknown and every branch with its across
 * variable, each with its own relation as equation; a pair is struck out where the relation gives
 * the unknown and following it never leads back to itself. What is followed: a chord's v along its
 * circuit, a branch's i from its cutset. In state form the tree is a normal tree, capacitors in it
 * and inductors out of it bring the states, and a rate that an equation needs of something
 * algebraic is an unknown more, with that one's equation differentiated. In the form of the user's
 * tree any rate of an unknown may be met, and the highest ones are solved for. theory.md 8. */
#include "formulate/system_impl.h"

#include <string.h>

#define DEEP 30 /* followed edges, from which on variables stay unknown: resolve() goes to 40 */

static const Instance *owner_of(const System *system, const Branchlike *branch)
{
    return &system->instances[branch->instance];
}

Branchlike *scalar_branch(System *system, const Instance *instance, int which)
{
    return &system->branches.at[system->scalar_of_edge[instance->scalar_edges[which]]];
}

const char *branch_member(System *system, const Branchlike *branch, bool through)
{
    const Edge *edge = graph_edge(system->graph, branch->edge);

    return system_keep(system, "%s.%s", edge->name,
                       through ? domain_through(edge->domain) : domain_across(edge->domain));
}

TreeKind branch_tree(const System *system, const Branchlike *branch)
{
    Domain domain = graph_edge(system->graph, branch->edge)->domain;
    TreeKind kind = TREE_ELECTRICAL;

    while (tree_kind_domain(kind) != domain)
        kind++;
    return kind;
}

/* --- relations --- */

/* a source whose value an inverse run finds: that unknown in the place of the value */
static void found_value(System *system, Instance *source)
{
    int param = component_source(source->row);
    size_t size = (size_t)source->row->param_count * sizeof(Value);

    for (int i = 0; i < system->drives.count; i++) {
        const Drive *drive = &system->drives.at[i];
        Value *values;

        if (!drive->by_source || system->instances[drive->instance].by != source->number)
            continue;
        values = pool_alloc(system->pool, size);
        memcpy(values, source->values, size);
        values[param].at[0] = drive->effort;
        source->values = values;
    }
}

static void add_leak(System *system, Expr across, Relation *relation)
{
    if (relation->kind != RELATION_CONDUCTIVE && relation->kind != RELATION_THROUGH)
        return;
    if (!expr_is_zero(expr_diff(system->arena, relation->value, across)))
        relation->value =
            expr_add(system->arena, relation->value, expr_mul(system->arena, system->leak, across));
}

static void read_relation(System *system, Branchlike *branch)
{
    const Instance *instance = owner_of(system, branch);
    Instance source;
    Arena *arena = system->arena;
    Expr zero = expr_int(arena, 0);
    Motion1 motion = {zero, zero, instance_across(instance, arena, branch->which),
                      instance_through(instance, arena, branch->which)};

    if (instance->joint >= 0) {
        const Instance *joint = &system->instances[instance->joint];

        motion.displacement = instance_coordinate(instance, joint, arena, 0);
        motion.rate = instance_coordinate(instance, joint, arena, 1);
    }
    source = *instance;
    found_value(system, &source);
    instance->row->relation(&source, arena, branch->which, &motion, &branch->relation);
    /* a source of current that follows its own voltage is a resistor */
    if (branch->relation.kind == RELATION_THROUGH &&
        !expr_is_zero(expr_diff(arena, branch->relation.value, motion.across)))
        branch->relation.kind = RELATION_CONDUCTIVE;
    if (system->leak != NULL)
        add_leak(system, motion.across, &branch->relation);
    if (branch->relation.kind == RELATION_IDEAL || branch->relation.switches)
        ideal_take_side(system, branch);
}

/* what couplings bring to the relations of two parts */
static void couple(System *system)
{
    for (int i = 0; i < system->instance_count; i++) {
        const Instance *instance = &system->instances[i];
        const Instance *parts[2];

        if (instance->row->couple == NULL)
            continue;
        for (int k = 0; k < 2; k++)
            parts[k] = &system->instances[instance->parts[k]];
        for (int k = 0; k < 2; k++)
            instance->row->couple(instance, system->arena, parts, k,
                                  &scalar_branch(system, parts[k], 0)->relation);
    }
}

/* what a relation differentiates by itself may not jump */
static Status check_smooth(System *system, Diag *diag)
{
    Expr e;
    Status status = OK;

    for (int i = 0; i < system->branches.count; i++) {
        const Branchlike *branch = &system->branches.at[i];

        if (branch->relation.smooth == NULL)
            continue;
        CHECK(resolve(system, branch->relation.smooth, &e, diag));
        if (need_smooth(system, owner_of(system, branch)->name, e, NULL) == OK)
            continue;
        status = diag_set(diag, E_MODEL, "%s takes the derivative of something that jumps",
                          owner_of(system, branch)->name);
        diag_hint(diag, "filter= smooths it, or give the source a rise time");
        goto done;
    }
done:
    return status;
}

static void find_cutsets(System *system, TreeKind kind)
{
    const Tree *tree = system->trees[kind];

    system->cutsets[kind] = tree_cutsets(tree);
    for (int r = 0; r < tree_branch_count(tree); r++) {
        Branchlike *branch = &system->branches.at[system->scalar_of_edge[tree_branches(tree)[r]]];

        branch->branch = true;
        branch->cutset = r;
    }
}

const char *network_company(System *system, const Branchlike *branch)
{
    const Tree *tree = system->trees[branch_tree(system, branch)];
    SignMatrix *matrix = branch->branch ? tree_cutsets(tree) : tree_circuits(tree);
    const int *edges = branch->branch ? tree_branches(tree) : tree_chords(tree);
    Text names = {0};
    const char *kept;

    for (int r = 0; r < matrix->rows; r++)
        for (int i = matrix->start[r]; edges[r] == branch->edge && i < matrix->start[r + 1]; i++)
            text_addf(&names, "%s%s", i > matrix->start[r] ? " " : "",
                      graph_edge(system->graph, matrix->column[i])->name);
    kept = system_keep(system, "%s", names.at != NULL ? names.at : "");
    text_free(&names);
    sign_matrix_free(matrix);
    return kept;
}

/* --- unknowns and their rates --- */

void network_know(System *system, Expr symbol, int unknown, int order)
{
    int number = expr_symbol_number(symbol);

    while (system->unknown_of.count <= number) {
        LIST_PUSH(system->unknown_of, 0);
        LIST_PUSH(system->rate_of, 0);
    }
    system->unknown_of.at[number] = 1 + unknown;
    system->rate_of.at[number] = order;
}

bool network_knows(const System *system, Expr symbol)
{
    int number = expr_symbol_number(symbol);

    return number < system->unknown_of.count && system->unknown_of.at[number] > 0;
}

static int new_unknown(System *system, Unknown unknown, const char *name, SymbolKind kind)
{
    unknown.symbol = expr_symbol(system->arena, name, kind);
    LIST_PUSH(system->unknowns, unknown);
    network_know(system, unknown.symbol, system->unknowns.count - 1, 0);
    return system->unknowns.count - 1;
}

/* one that is an expression leaves the order as it is */
static void push_rate(System *system, Unknown *y, Expr rate, bool is_expression)
{
    Expr *rates = pool_alloc(system->pool, (size_t)(y->known + 1) * sizeof(Expr));

    if (y->known > 0)
        memcpy(rates, y->rates, (size_t)y->known * sizeof(Expr));
    rates[y->known++] = rate;
    y->rates = rates;
    if (!is_expression)
        y->order = y->known;
}

/* one rate more of an unknown, as a symbol */
static Expr add_rate(System *system, int unknown, SymbolKind kind)
{
    Unknown *y = &system->unknowns.at[unknown];
    const char *last = expr_name(y->order > 0 ? y->rates[y->order - 1] : y->symbol);
    Expr rate = expr_symbol(system->arena, system_keep(system, "%s'", last), kind);

    push_rate(system, y, rate, false);
    network_know(system, rate, unknown, y->order);
    return rate;
}

static int add_state(System *system, Unknown unknown, const char *name)
{
    int k = new_unknown(system, unknown, name, SYMBOL_STATE);

    if (system->network_form == NETWORK_STATE)
        (void)add_rate(system, k, SYMBOL_STATE_RATE);
    return k;
}

static Unknown unknown_of_branch(const System *system, const Branchlike *branch)
{
    return (Unknown){.branchlike = (int)(branch - system->branches.at),
                     .own = -1,
                     .instance = branch->instance,
                     .derives = -1};
}

/* a chord whose current is a function of its voltage, as a diode's: steep in that direction */
static bool is_steep(const System *system, const Branchlike *branch)
{
    const Relation *relation = &branch->relation;

    return !branch->branch &&
           (relation->kind == RELATION_CONDUCTIVE || relation->kind == RELATION_THROUGH) &&
           expr_depends(relation->value,
                        instance_across(owner_of(system, branch), system->arena, branch->which));
}

/* The edge's own variable stays unknown, with its relation as equation. Of a steep chord it is the
 * voltage, from which Newton's method finds the current, as it would not the other way round; its
 * equation is the circuit. */
static Status keep_unknown(System *system, Branchlike *branch, Diag *diag)
{
    bool steep = is_steep(system, branch);
    const char *name = branch_member(system, branch, !branch->branch && !steep);
    bool state_form = system->network_form == NETWORK_STATE;
    Status status = OK;

    if (branch->unknown >= 0)
        return OK;
    branch->unknown = new_unknown(system, unknown_of_branch(system, branch), name,
                                  state_form ? SYMBOL_ALGEBRAIC : SYMBOL_STATE);
    if (!steep)
        return OK;
    branch->is_steep = true;
    branch->v = system->unknowns.at[branch->unknown].symbol;
    CHECK(resolve(system, branch->relation.value, &branch->i, diag));
    branch->i = expr_hold(system->arena, branch->i);
done:
    return status;
}

/* how often the equation of an unknown has been differentiated */
static int derivations(const System *system, int unknown)
{
    int count = 0;

    for (; system->unknowns.at[unknown].derives >= 0; count++)
        unknown = system->unknowns.at[unknown].derives;
    return count;
}

Status network_rate(System *system, Expr symbol, Expr *out, Diag *diag)
{
    int number = expr_symbol_number(symbol);
    int k = system->unknown_of.at[number] - 1;
    int order = system->rate_of.at[number];
    Unknown *y = &system->unknowns.at[k];
    Status status = OK;

    if (order < y->known) {
        *out = y->rates[order];
        return OK;
    }
    if (!system->is_network_open)
        return diag_set(diag, E_MISSING,
                        "the derivative of %s is not among the network's equations",
                        expr_name(symbol));
    if (order + derivations(system, k) >=
        (system->network_form == NETWORK_TREE ? NETWORK_ORDER : 3)) {
        system->has_no_states = system->network_form == NETWORK_STATE;
        (void)diag_set(diag, E_MODEL, "the network's equations need ever more derivatives of %s",
                       expr_name(y->symbol));
        diag_hint(diag, "a source controlled by it stands among inductors or capacitors alone: "
                        "put a resistance there");
        return E_MODEL;
    }
    if (y->order < y->known) {
        CHECK(rate_of(system, y->rates[y->known - 1], out, diag));
        push_rate(system, &system->unknowns.at[k], *out, true);
    } else if (system->network_form == NETWORK_TREE) {
        *out = add_rate(system, k, SYMBOL_STATE);
    } else {
        /* algebraic, or the rate of a state: its equation differentiated tells it */
        Unknown more = {.branchlike = -1, .own = -1, .instance = y->instance, .derives = k};
        const char *name = system_keep(system, "%s'", expr_name(symbol));
        int added = new_unknown(system, more, name, SYMBOL_ALGEBRAIC);

        *out = system->unknowns.at[added].symbol;
        push_rate(system, &system->unknowns.at[k], *out, false);
    }
done:
    return status;
}

/* --- across and through variables --- */

/* sum of across variables along the tree path from tail to head */
Status circuit_across(System *system, Branchlike *branch, Expr *out, Diag *diag)
{
    const Edge *edge = graph_edge(system->graph, branch->edge);
    const Tree *tree = system->trees[branch_tree(system, branch)];
    int room = tree_depth(tree, edge->tail) + tree_depth(tree, edge->head);
    int *edges = NEW_ARRAY(int, room);
    int *signs = NEW_ARRAY(int, room);
    Expr *terms = NEW_ARRAY(Expr, room);
    int count = tree_path(tree, edge->tail, edge->head, edges, signs);
    Status status = OK;

    for (int i = 0; i < count; i++) {
        Branchlike *other = &system->branches.at[system->scalar_of_edge[edges[i]]];
        Expr v;

        if (branch->busy && other->busy && other->unknown < 0) {
            /* a loop: rather the chord stays unknown, as a mesh current */
            system->met_loop = true;
            CHECK(diag_set(diag, E_MISSING, "%s leads back to itself", edge->name));
        }
        CHECK(network_across(system, other, &v, diag));
        terms[i] = signs[i] > 0 ? v : expr_neg(system->arena, v);
    }
    *out = expr_sum(system->arena, terms, count);
done:
    mem_free(edges);
    mem_free(signs);
    mem_free(terms);
    return status;
}

/* minus the sum of the chords' through variables in the cutset */
static Status cutset_through(System *system, Branchlike *branch, Expr *out, Diag *diag)
{
    const SignMatrix *cutsets = system->cutsets[branch_tree(system, branch)];
    LIST(Expr) terms = {0};
    Status status = OK;

    for (int k = cutsets->start[branch->cutset]; k < cutsets->start[branch->cutset + 1]; k++) {
        Branchlike *chord = &system->branches.at[system->scalar_of_edge[cutsets->column[k]]];
        Expr i;

        if (chord == branch)
            continue;
        CHECK(network_through(system, chord, &i, diag));
        LIST_PUSH(terms, cutsets->entry[k] < 0 ? i : expr_neg(system->arena, i));
    }
    *out = expr_sum(system->arena, terms.at, terms.count);
done:
    LIST_FREE(terms);
    return status;
}

/* content' + rest */
static Status stored_rate(System *system, const Branchlike *branch, Expr *out, Diag *diag)
{
    const Relation *relation = &branch->relation;
    Expr rest;
    Status status = OK;

    CHECK(resolve(system, relation->content, out, diag));
    CHECK(need_smooth(system, graph_edge(system->graph, branch->edge)->name, *out, diag));
    CHECK(rate_of(system, *out, out, diag));
    CHECK(resolve(system, relation->rest, &rest, diag));
    *out = expr_add(system->arena, *out, rest);
done:
    return status;
}

/* v = value * i + rest, or i = (v - rest) / value */
static Status resistive(System *system, Branchlike *branch, bool *given, Expr *out, Diag *diag)
{
    Arena *arena = system->arena;
    Expr other;
    Expr value;
    Expr rest;
    Status status = OK;

    if (!branch->branch && branch->relation.inverse != NULL)
        return resolve(system, branch->relation.inverse, out, diag);
    CHECK(branch->branch ? network_through(system, branch, &other, diag)
                         : network_across(system, branch, &other, diag));
    CHECK(resolve(system, branch->relation.value, &value, diag));
    CHECK(resolve(system, branch->relation.rest, &rest, diag));
    *given = branch->branch || !expr_is_zero(value);
    if (branch->branch)
        *out = expr_add(arena, expr_mul(arena, value, other), rest);
    else if (*given)
        *out = expr_div(arena, expr_sub(arena, other, rest), value);
done:
    return status;
}

bool port_gives_own(System *system, const Branchlike *branch)
{
    return branch->which == 0 ||
           scalar_branch(system, owner_of(system, branch), 0)->branch != branch->branch;
}

/* v of a branch or i of a chord where its relation gives it; *given false where it doesn't */
static Status by_relation(System *system, Branchlike *branch, bool *given, Expr *out, Diag *diag)
{
    const Relation *relation = &branch->relation;

    *given = true;
    switch (relation->kind) {
    case RELATION_RESISTIVE:
        return resistive(system, branch, given, out, diag);
    case RELATION_ACROSS:
        if (branch->branch)
            return resolve(system, relation->value, out, diag);
        break;
    case RELATION_INDUCTIVE:
        if (branch->branch)
            return stored_rate(system, branch, out, diag);
        break;
    case RELATION_THROUGH:
    case RELATION_CONDUCTIVE:
        if (!branch->branch)
            return resolve(system, relation->value, out, diag);
        break;
    case RELATION_CAPACITIVE:
        if (!branch->branch)
            return stored_rate(system, branch, out, diag);
        break;
    case RELATION_PORT:
        if (port_gives_own(system, branch))
            return resolve(system, branch->branch ? relation->value : relation->inverse, out, diag);
        break;
    case RELATION_FREE:
    case RELATION_IDEAL:
        break;
    }
    *given = false;
    return OK;
}

/* The edge's own variable, v of a branch or i of a chord: given by its relation, or unknown. */
static Status own_variable(System *system, Branchlike *branch, Expr *out, Diag *diag)
{
    bool given = false;
    Diag before = diag != NULL ? *diag : (Diag){0};
    Status status = OK;

    *out = NULL;
    if (branch->unknown < 0 && !branch->busy && system->follow_depth < DEEP) {
        branch->busy = true;
        system->follow_depth++;
        system->asked_early = false;
        status = by_relation(system, branch, &given, out, diag);
        system->follow_depth--;
        branch->busy = false;
        if (status != OK && (system->asked_early || (!branch->branch && system->met_loop))) {
            /* what it reads follows from forces, and waits for those; or a loop */
            system->met_loop = false;
            given = false;
            status = OK;
            if (diag != NULL)
                *diag = before;
        }
        CHECK(status);
    }
    /* it was met again on the way, or nothing gives it */
    if (!given)
        CHECK(keep_unknown(system, branch, diag));
    if (branch->is_steep)
        *out = branch->i;
    else if (branch->unknown >= 0)
        *out = system->unknowns.at[branch->unknown].symbol;
done:
    return status;
}

Status network_across(System *system, Branchlike *branch, Expr *out, Diag *diag)
{
    Status status = OK;

    if (branch->v == NULL) {
        if (branch->branch)
            CHECK(own_variable(system, branch, out, diag));
        else
            CHECK(circuit_across(system, branch, out, diag));
        if (!branch->is_steep)
            branch->v = expr_hold(system->arena, *out);
    }
    *out = branch->v;
done:
    return status;
}

Status network_through(System *system, Branchlike *branch, Expr *out, Diag *diag)
{
    Status status = OK;

    if (branch->i == NULL) {
        if (branch->branch)
            CHECK(cutset_through(system, branch, out, diag));
        else
            CHECK(own_variable(system, branch, out, diag));
        if (!branch->is_steep)
            branch->i = expr_hold(system->arena, *out);
    }
    *out = branch->i;
done:
    return status;
}

/* --- building --- */

static void add_states(System *system)
{
    for (int b = 0; b < system->branches.count; b++) {
        Branchlike *branch = &system->branches.at[b];
        RelationKind kind = branch->relation.kind;

        if ((kind == RELATION_CAPACITIVE && branch->branch) ||
            (kind == RELATION_INDUCTIVE && !branch->branch))
            branch->unknown = add_state(system, unknown_of_branch(system, branch),
                                        branch_member(system, branch, !branch->branch));
        if (branch->which > 0 || owner_of(system, branch)->row->own_state_count == NULL)
            continue;
        for (int k = 0;
             k < owner_of(system, branch)->row->own_state_count(owner_of(system, branch)); k++) {
            const Instance *owner = owner_of(system, branch);
            OwnState own;

            owner->row->own_state(owner, system->arena, k, &own);
            (void)add_state(
                system,
                (Unknown){.branchlike = -1, .own = k, .instance = branch->instance, .derives = -1},
                system_keep(system, "%s.%s", owner->name, own.member));
        }
    }
}

static void add_branches(System *system)
{
    int count = graph_edge_count(system->graph);

    system->scalar_of_edge = pool_alloc(system->pool, (size_t)count * sizeof(int));
    for (int e = 0; e < count; e++)
        system->scalar_of_edge[e] = -1;
    for (int i = 0; i < system->instance_count; i++)
        for (int k = 0; k < system->instances[i].scalar_count; k++) {
            int edge = system->instances[i].scalar_edges[k];

            system->scalar_of_edge[edge] = system->branches.count;
            LIST_PUSH(
                system->branches,
                (Branchlike){.edge = edge, .instance = i, .which = k, .unknown = -1, .ideal = -1});
        }
}

Status network_build(System *system, Diag *diag)
{
    Expr value;
    Status status = OK;

    system->is_network_open = true;
    add_branches(system);
    for (int i = 0; i < system->branches.count; i++)
        read_relation(system, &system->branches.at[i]);
    couple(system);
    for (TreeKind kind = TREE_ELECTRICAL; kind < TREE_KINDS; kind++) {
        if (system->trees[kind] == NULL)
            continue;
        CHECK(network_normal_tree(system, kind, diag));
        find_cutsets(system, kind);
    }
    add_states(system);
    /* chords first: their currents are the ones to stay unknown */
    for (int i = 0; i < system->branches.count; i++)
        if (!system->branches.at[i].branch)
            CHECK(network_through(system, &system->branches.at[i], &value, diag));
    for (int i = 0; i < system->branches.count; i++) {
        CHECK(network_across(system, &system->branches.at[i], &value, diag));
        CHECK(network_through(system, &system->branches.at[i], &value, diag));
        CHECK(poll(system->watch));
    }
    CHECK(check_smooth(system, diag));
    if (system->network_form == NETWORK_TREE)
        CHECK(network_bring_order(system, diag));
    network_list(system);
done:
    return status;
}
