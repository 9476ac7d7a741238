/* initial_place_impl.h: what the files that place frames share */
#ifndef COTREE_SIMULATE_ASSEMBLE_INITIAL_PLACE_IMPL_H
#define COTREE_SIMULATE_ASSEMBLE_INITIAL_PLACE_IMPL_H

#include "simulate/assemble/initial_impl.h"

typedef enum Knowledge { KNOWN_NOT, KNOWN_GUESSED, KNOWN_GIVEN } Knowledge;

/* a value that was told, of a coordinate or of a frame against the datum */
typedef struct InitialGuess {
    int link; /* number; -1: of a frame, */
    int head; /* this node */
    int k;    /* coordinate of the link */
    double value;
    bool is_guess;
    int group;        /* of Euler parameters told together; -1 */
    const char *name; /* of a guess, borrowed; NULL of others */
} InitialGuess;

typedef enum ColumnKind { COLUMN_SLIDE, COLUMN_TURN, COLUMN_FREE } ColumnKind;

typedef struct PlaceColumn { /* an unknown of the search */
    int link;
    ColumnKind kind;
    int k; /* shift or turn; axis of a free rotation */
} PlaceColumn;

typedef enum QueryKind { QUERY_SHIFT, QUERY_TURN, QUERY_TIE, QUERY_GUESS } QueryKind;

typedef struct Query { /* rows of the search */
    QueryKind kind;
    int link; /* or wish */
} Query;

typedef struct Placing {
    Assembly *a;
    const KinematicTree *s;
    Tree *trees[2];   /* translation, rotation */
    double *c;        /* links x POSE_COORDS */
    double *begun;    /* likewise: where what isn't given starts, NAN: not asked yet */
    Knowledge *known; /* likewise */
    Pose *poses;
    LIST(InitialGuess) guess_list;
    double *groups; /* x POSE_COORDS: what was told of each, the rest 0 */
    LIST(PlaceColumn) columns;
    LIST(Query) asks;
    int row_count, guess_count; /* the last ones are of guesses, one each */
    double *turned, *shifted;   /* nodes x 3: what a unit of a column does to them */
    bool goes_on;               /* whole turns of angles are those of before */
} Placing;

/* the place of coordinate k of a link in what is kept by link and coordinate */
static inline int place_at(int link, int k)
{
    return link * POSE_COORDS + k;
}

/* Guesses, drivers, given values: what comes later has the last word (initial_known.c). */
MUST_USE Status place_read_guesses(Placing *p, Diag *diag);
void place_mark_known(Placing *p);
/* How little is known of a half of a link: OPEN for each freedom that is, 1 for a guessed one. */
enum { OPEN = 16 }; /* above the number of coordinates of a link */
int place_ignorance(const Placing *p, int link, TreeKind kind);

/* The trees that place frames, by what is known; fails as tree_complete() does. */
MUST_USE Status place_choose_trees(Placing *p, Diag *diag);
void placing_free(Placing *p); /* what it holds */

/* Whether a link is a branch of the trees that place frames, and a coordinate is one of such. */
bool place_turns(const Placing *p, int link);
bool place_shifts(const Placing *p, int link);
bool place_has(const Placing *p, int link, int k);
void place_poses(Placing *p, const double *c);

void place_columns(Placing *p); /* list the unknowns (initial_search.c) */
/* Close what the trees leave open; false: nothing was found that does. */
bool place_search(Placing *p, bool guesses);

/* the rows of a search and what they are of (initial_search.c) */
typedef struct PlaceSearch {
    Placing *p;
    Rows rows;
    LinkRow *link_rows;
    int *tails, *heads;
} PlaceSearch;

void place_open_search(PlaceSearch *search, Placing *p, bool guesses);
void place_close_search(PlaceSearch *search); /* what it holds */
/* where the frame that is furthest from the datum stands, m; 1 where all stand there */
double place_size(const Placing *p);
/* What a residual is multiplied by: lengths over `size` (m), angles as they are (rad), guesses
 * `guesses` times that. After an evaluation. */
void place_row_scales(const PlaceSearch *search, double size, double guesses, double *scale);
/* what wish `number` is where frames stand, less its value; whether that is a length (m) */
double place_missed(Placing *p, int number, bool *is_length);

#define PLACE_APPROACHED 1e-12 /* scaled: guesses are met if they can be */

/* An assembly that meets all guesses, or the one with the least distance to them. Where no loop
 * closes from any start, where the first one comes nearest to guesses and loops. Without guesses
 * nothing moves (initial_guesses.c). */
void place_by_guesses(Placing *p);
/* A remark for each guess that the assembly is far from. */
void place_remark_guesses(Placing *p);

#endif
