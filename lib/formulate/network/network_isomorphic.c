/* network_isomorphic.c: rows of a network that are recalled, or taken over from another instance */
#include "formulate/network/network_isomorphic.h"

#include "base/names.h"
#include "base/text.h"
#include "formulate/kinematics/identity.h"
#include "formulate/network/network_build.h"
#include "formulate/network/network_impl.h"
#include "formulate/network/scalar_edges.h"
#include "formulate/system/origin.h"
#include "formulate/system/resolve.h"
#include "formulate/system/system_impl.h"

#include <string.h>

enum { MOST_SYMBOLS = MOST_KEY };

/* all that a row follows from: symbols and expressions, and the kind of row */
typedef struct DeterminedSymbols {
    Expr at[MOST_SYMBOLS];
    int count; /* 0: the row follows from others as well */
    int kind;
    int unknowns; /* number of unknowns before it was derived */
} DeterminedSymbols;

typedef struct KnownRow { /* an unknown's */
    DeterminedSymbols determined;
    Expr key;           /* key of these */
    int like;           /* the unknown whose row it took over; -1 */
    Renaming *renaming; /* borrowed: from that unknown's names */
    Expr left, right, lack;
    bool has_slopes;
    NetworkSlopes slopes;
} KnownRow;

typedef struct SymbolPair { /* of instances */
    int first, own;
    Renaming *renaming;
} SymbolPair;

struct NetworkIsomorphism {
    Names *uses;    /* instances */
    Names *local;   /* definition and name inside it, for each unknown, */
    LIST(int) last; /* and the unknown derived last under each name */
    LIST(int) last_use;
    LIST(KnownRow) of; /* unknowns */
    char **prefix;     /* "leg1." */
    Original **original;
    LIST(SymbolPair) pairs;
    int use_count;
};

static NetworkIsomorphism *isomorphic_of(System *system)
{
    const Origin *origin = system->origin;
    NetworkIsomorphism *alike = system->network->alike;

    if (alike != NULL)
        return alike;
    alike = system->network->alike = NEW(NetworkIsomorphism);
    alike->uses = names_borrowing();
    alike->local = names_new();
    alike->use_count = origin->use_count;
    alike->prefix = NEW_ARRAY(char *, origin->use_count);
    alike->original = NEW_ARRAY(Original *, origin->use_count);
    for (int i = 0; i < origin->use_count; i++) {
        Text prefix = {0};

        (void)names_add(alike->uses, origin->uses[i].name);
        text_addf(&prefix, "%s.", origin->uses[i].name);
        alike->prefix[i] = text_done(&prefix);
    }
    return alike;
}

static void slopes_free(NetworkSlopes *slopes)
{
    LIST_FREE(slopes->symbols);
    LIST_FREE(slopes->values);
}

void network_isomorphic_free(NetworkIsomorphism *alike)
{
    if (alike == NULL)
        return;
    for (int i = 0; i < alike->of.count; i++)
        slopes_free(&alike->of.at[i].slopes);
    for (int i = 0; i < alike->pairs.count; i++)
        renaming_free(alike->pairs.at[i].renaming);
    for (int i = 0; i < alike->use_count; i++) {
        original_free(alike->original[i]);
        mem_free(alike->prefix[i]);
    }
    names_free(alike->uses);
    names_free(alike->local);
    LIST_FREE(alike->last);
    LIST_FREE(alike->last_use);
    LIST_FREE(alike->of);
    LIST_FREE(alike->pairs);
    MEM_FREE(alike->prefix, alike->original);
    mem_free(alike);
}

static KnownRow *derived_of(NetworkIsomorphism *alike, int unknown)
{
    while (alike->of.count <= unknown)
        LIST_PUSH(alike->of, (KnownRow){.like = -1});
    return &alike->of.at[unknown];
}

/* --- what a row follows from --- */

static bool is_determined(const System *system, const Unknown *y)
{
    const Branchlike *branch =
        y->branchlike >= 0 ? &system->network->branches.at[y->branchlike] : NULL;

    return branch != NULL && y->derives < 0 && system->network->form == NETWORK_STATE &&
           branch->ideal < 0 && !branch->is_stiff && !branch->is_balanced &&
           branch->relation.kind != RELATION_PORT && branch->relation.kind != RELATION_FREE &&
           branch->relation.kind != RELATION_IMPLICIT && branch->relation.kind != RELATION_IDEAL;
}

static void find_status(DeterminedSymbols *determined, Expr e)
{
    if (determined->count == MOST_SYMBOLS)
        determined->count = 0;
    if (determined->count > 0)
        determined->at[determined->count++] = e;
}

/* variables of the user, and their expressions; rates of other unknowns may be unknowns */
static void find_symbols(System *system, const Unknown *y, const Relation *relation,
                         DeterminedSymbols *determined)
{
    const Expr none = expr_int(system->arena, 0);
    const Expr roots[] = {relation->value != NULL ? relation->value : none,
                          relation->rest != NULL ? relation->rest : none,
                          relation->content != NULL ? relation->content : none};
    Expr *symbols;
    const int count = expr_symbols(roots, COUNT(roots), &symbols);

    for (int i = 0; i < count && determined->count > 0; i++) {
        const SymbolKind kind = expr_symbol_kind(symbols[i]);
        Expr value;

        if (kind == SYMBOL_VARIABLE) {
            if (variables_resolve(system, symbols[i], &value, NULL) != OK)
                determined->count = 0; /* deriving it reports the reason */
            find_status(determined, symbols[i]);
            find_status(determined, value);
        } else if (kind != SYMBOL_PARAMETER && kind != SYMBOL_TIME && symbols[i] != y->symbol &&
                   relation->content != NULL)
            determined->count = 0;
    }
    mem_free(symbols);
}

static Status find_determined(System *system, const Unknown *y, DeterminedSymbols *determined,
                              Diag *diag)
{
    Branchlike *branch = &system->network->branches.at[y->branchlike];
    const Relation *relation = &branch->relation;
    Expr v, i;

    TRY(network_across(system, branch, &v, diag));
    TRY(network_through(system, branch, &i, diag));
    *determined = (DeterminedSymbols){.at = {y->symbol}, .count = 1};
    determined->kind = (int)relation->kind | branch->branch << 4 | (relation->value != NULL) << 5 |
                       (relation->rest != NULL) << 6 | (relation->content != NULL) << 7 |
                       y->order << 8 | y->known << 16;
    find_status(determined, v);
    find_status(determined, i);
    for (int k = 0; k < y->known; k++)
        find_status(determined, y->rates[k]);
    if (relation->value != NULL)
        find_status(determined, relation->value);
    if (relation->rest != NULL)
        find_status(determined, relation->rest);
    if (relation->content != NULL)
        find_status(determined, relation->content);
    find_symbols(system, y, relation, determined);
    return OK;
}

static Expr row_key(const System *system, const DeterminedSymbols *determined)
{
    const Expr kind = expr_int(system->arena, determined->kind);
    Key key = key_of(kind);

    key_add(&key, determined->at, (size_t)determined->count * sizeof *determined->at);
    return key_end(system, &key);
}

/* --- which instance a row belongs to --- */

/* the innermost instance that the name is in, or the next one around `inside`; -1 */
static int use_around(const System *system, const NetworkIsomorphism *alike, const char *name,
                      int inside)
{
    int found = -1;

    if (inside >= 0)
        return system->origin->uses[inside].outer;
    for (const char *dot = strchr(name, '.'); dot != NULL; dot = strchr(dot + 1, '.')) {
        const int use = names_find_part(alike->uses, name, (size_t)(dot - name));

        if (use >= 0)
            found = use;
    }
    return found;
}

/* name of an unknown inside an instance: new */
static char *local_name(const System *system, const NetworkIsomorphism *alike, const char *name,
                        int use)
{
    Text text = {0};

    text_add(&text, system->origin->uses[use].definition);
    text_char(&text, ' ');
    text_add(&text, name + strlen(alike->prefix[use]));
    return text_done(&text);
}

static Renaming *renaming_between(const System *system, NetworkIsomorphism *alike, int first,
                                  int own)
{
    for (int i = alike->pairs.count - 1; i >= 0; i--)
        if (alike->pairs.at[i].first == first && alike->pairs.at[i].own == own)
            return alike->pairs.at[i].renaming;
    if (alike->original[first] == NULL)
        alike->original[first] = original_new(system->arena, alike->prefix[first]);
    LIST_PUSH(alike->pairs,
              (SymbolPair){first, own, renaming_new(alike->original[first], alike->prefix[own])});
    return alike->pairs.at[alike->pairs.count - 1].renaming;
}

static bool same_determined(Renaming *renaming, const DeterminedSymbols *first,
                            const DeterminedSymbols *own)
{
    bool same = first->count == own->count && first->kind == own->kind;

    for (int k = 0; same && k < own->count; k++)
        same = renaming_of(renaming, first->at[k]) == own->at[k];
    return same;
}

/* takes over the row of the same name in another instance, if it is equal after renaming */
static bool take_over(System *system, NetworkIsomorphism *alike, const Unknown *y, KnownRow *own)
{
    const char *name = expr_name(y->symbol);

    for (int use = use_around(system, alike, name, -1); use >= 0;
         use = use_around(system, alike, name, use)) {
        char *local = local_name(system, alike, name, use);
        const int known = names_find(alike->local, local);
        const int first = known >= 0 ? alike->last.at[known] : -1;

        mem_free(local);
        if (first < 0 || alike->last_use.at[known] == use)
            continue;
        own->renaming = renaming_between(system, alike, alike->last_use.at[known], use);
        if (!same_determined(own->renaming, &alike->of.at[first].determined, &own->determined))
            continue;
        own->like = first;
        own->left = renaming_of(own->renaming, alike->of.at[first].left);
        own->right = renaming_of(own->renaming, alike->of.at[first].right);
        own->lack = renaming_of(own->renaming, alike->of.at[first].lack);
        return true;
    }
    return false;
}

static void offer(System *system, NetworkIsomorphism *alike, int unknown, const char *name)
{
    for (int use = use_around(system, alike, name, -1); use >= 0;
         use = use_around(system, alike, name, use)) {
        char *local = local_name(system, alike, name, use);
        const int known = names_add(alike->local, local);

        if (known == alike->last.count) {
            LIST_PUSH(alike->last, unknown);
            LIST_PUSH(alike->last_use, use);
        }
        alike->last.at[known] = unknown;
        alike->last_use.at[known] = use;
        mem_free(local);
    }
}

/* --- rows --- */

typedef struct KeptRow { /* a row as it is stored */
    Expr left, right, lack;
} KeptRow;

static void remember(System *system, const KnownRow *own)
{
    const KeptRow row = {own->left, own->right, own->lack};

    derived_store(system, own->key, DERIVED_NETWORK_ROW, &row, sizeof row);
}

Status network_isomorphic_find(System *system, int unknown, Unknown *y, bool *found, Diag *diag)
{
    NetworkIsomorphism *alike;
    KnownRow own = {.like = -1};
    KeptRow row;

    *found = false;
    if (!is_determined(system, y))
        return OK;
    TRY(find_determined(system, y, &own.determined, diag));
    alike = isomorphic_of(system);
    if (own.determined.count > 0) {
        own.key = row_key(system, &own.determined);
        *found = derived_recall(system, own.key, DERIVED_NETWORK_ROW, &row, sizeof row);
        if (*found) {
            own.left = row.left;
            own.right = row.right;
            own.lack = row.lack;
        } else {
            *found = take_over(system, alike, y, &own);
            if (*found)
                remember(system, &own);
        }
    }
    own.determined.unknowns = system->network->unknowns.count;
    y->left = own.left;
    y->right = own.right;
    y->lack = own.lack;
    *derived_of(alike, unknown) = own;
    if (*found && own.like < 0)
        offer(system, alike, unknown, expr_name(y->symbol));
    return OK;
}

void network_isomorphic_keep(System *system, int unknown, const Unknown *y)
{
    NetworkIsomorphism *alike = system->network->alike;
    KnownRow *own;

    if (alike == NULL || unknown >= alike->of.count)
        return;
    own = &alike->of.at[unknown];
    /* a row that adds further unknowns is always derived */
    if (own->determined.count == 0 || own->determined.unknowns != system->network->unknowns.count) {
        own->determined.count = 0;
        return;
    }
    own->left = y->left;
    own->right = y->right;
    own->lack = y->lack;
    remember(system, own);
    offer(system, alike, unknown, expr_name(y->symbol));
}

/* --- Jacobian entries --- */

static KnownRow *determined_of(const System *system, int unknown)
{
    NetworkIsomorphism *alike = system->network->alike;

    return alike != NULL && unknown < alike->of.count && alike->of.at[unknown].determined.count > 0
               ? &alike->of.at[unknown]
               : NULL;
}

static void copy_slopes(NetworkSlopes *to, const NetworkSlopes *from, Renaming *renaming)
{
    to->symbols.count = to->values.count = 0;
    for (int i = 0; i < from->symbols.count; i++) {
        LIST_PUSH(to->symbols, renaming != NULL ? renaming_of(renaming, from->symbols.at[i])
                                                : from->symbols.at[i]);
        LIST_PUSH(to->values, renaming != NULL ? renaming_of(renaming, from->values.at[i])
                                               : from->values.at[i]);
    }
    to->rest = renaming != NULL ? renaming_of(renaming, from->rest) : from->rest;
    to->is_nonlinear = from->is_nonlinear;
}

bool network_isomorphic_slopes(System *system, int unknown, NetworkSlopes *slopes)
{
    const KnownRow *own = determined_of(system, unknown);
    Expr kept;

    if (own == NULL)
        return false;
    if (own->like >= 0 && system->network->alike->of.at[own->like].has_slopes) {
        copy_slopes(slopes, &system->network->alike->of.at[own->like].slopes, own->renaming);
        return true;
    }
    if (!derived_recall(system, own->key, DERIVED_NETWORK_SLOPES, &kept, sizeof kept))
        return false;
    slopes->symbols.count = slopes->values.count = 0;
    slopes->rest = expr_arg(kept, 0);
    slopes->is_nonlinear = !expr_is_zero(expr_arg(kept, 1));
    for (int i = 2; i < expr_arg_count(kept); i += 2) {
        LIST_PUSH(slopes->symbols, expr_arg(kept, i));
        LIST_PUSH(slopes->values, expr_arg(kept, i + 1));
    }
    return true;
}

void network_isomorphic_keep_slopes(System *system, int unknown, const NetworkSlopes *slopes)
{
    KnownRow *own = determined_of(system, unknown);
    LIST(Expr) entries = {0};
    Expr kept;

    if (own == NULL)
        return;
    if (own->like < 0) {
        copy_slopes(&own->slopes, slopes, NULL);
        own->has_slopes = true;
    }
    LIST_PUSH(entries, slopes->rest);
    LIST_PUSH(entries, expr_int(system->arena, slopes->is_nonlinear));
    for (int i = 0; i < slopes->symbols.count; i++) {
        LIST_PUSH(entries, slopes->symbols.at[i]);
        LIST_PUSH(entries, slopes->values.at[i]);
    }
    kept = expr_tuple(system->arena, entries.at, entries.count);
    derived_store(system, own->key, DERIVED_NETWORK_SLOPES, &kept, sizeof kept);
    LIST_FREE(entries);
}
