/* session_parameter_search.h: a search over parameters of the model: which, between which bounds,
 * and the runs with other values of them
 *
 * Parameters of each run are overrides of the model's, as in a sweep. What is found becomes
 * definitions of the model, one step of its history. Runs have a finer tolerance than by default,
 * for difference quotients of them. Those of one call share the processes of a sweep. */
#ifndef COTREE_SESSION_SESSION_PARAMETER_SEARCH_H
#define COTREE_SESSION_SESSION_PARAMETER_SEARCH_H

#include "session/session_sweep.h"

/* relative steps of difference quotients: their error is then that of the square of 1e-4, and of
 * the runs' tolerance over 1e-4 */
#define SEARCH_STEP 1e-4
/* of a value of a run, relative to its size */
#define SEARCH_NOISE 1e-9

typedef struct SearchUnknown {
    const char *name;
    Place place;
    double start, low, high; /* SI; infinite: no bound */
} SearchUnknown;

typedef struct ParameterSearch {
    ct_session *session;
    const Statement *statement;
    const char *hint; /* a statement as it may be written */
    LIST(SearchUnknown) unknowns;
    int values; /* of a run */
    /* those of the last run, after it */
    Status (*read)(const struct ParameterSearch *search, double *out, Diag *diag);
    int evaluations;
    Diag why; /* of the first run that failed; status OK: none has */

    int jobs;
    bool has_jobs;       /* jobs= or `set jobs` */
    int overrides, runs; /* of the session, before */
    double run_time;     /* of the last run in this process, s */
    SessionFocus focus;
    void (*progress)(void *context, const char *phase, double fraction);
} ParameterSearch;

/* Read what is after the colon, and jobs=; `purpose`: what its figures would do. The search needs
 * parameter_search_free() even after a failure. */
MUST_USE Status parameter_search_read(ParameterSearch *out, ct_session *session,
                                      const Statement *statement, const char *purpose,
                                      const char *hint, Diag *diag);
/* the parameters that the statement names */
MUST_USE Status parameter_search_read_unknowns(ParameterSearch *search, Diag *diag);
void parameter_search_free(ParameterSearch *search);

/* All runs are made between these. */
void parameter_search_begin(ParameterSearch *search);
void parameter_search_end(ParameterSearch *search);
/* A run in this process, of which the session then has the result; parameter_search_forget() ends
 * that. */
MUST_USE Status parameter_search_run(ParameterSearch *search, const double *x, Diag *diag);
void parameter_search_forget(const ParameterSearch *search);
/* A PointsFunction of a ParameterSearch: values of a run each. A run that fails has none. */
MUST_USE Status parameter_search_evaluate(void *search, int count, const double *points,
                                          double *out, Diag *diag);

/* "k = 0.25 [N/m]" of each: one step of the model's history */
MUST_USE Status parameter_search_define(const ParameterSearch *search, const double *x, Diag *diag);
/* the statement after the colon once more, as if it had been typed */
MUST_USE Status parameter_search_run_last(const ParameterSearch *search, Diag *diag);

/* E_STOPPED: the message of a search that ended with the best values so far */
Status parameter_search_stopped(const ParameterSearch *search, Diag *diag);

/* the value of a key; NULL: it is not there */
const Syntax *statement_key(const Statement *statement, const char *name);
/* [a, b] is a list, anything else a list of one, and NULL an empty one */
int syntax_list_count(const Syntax *list);
const Syntax *syntax_list_item(const Syntax *list, int i);

#endif
