/* A pendulum in libcotree: build it, choose its tree, run it, and read the results. Ctrl-C
 * stops the run, which keeps its results so far. */
#include <cotree.h>

#include <inttypes.h>
#include <signal.h>
#include <stdio.h>

static volatile sig_atomic_t interrupted;

static void on_interrupt(int signal)
{
    (void)signal;
    interrupted = 1;
}

static bool is_stopped(void *context)
{
    (void)context;
    return interrupted != 0;
}

/* carry out statements: ct_apply() changes the model, ct_run() computes */
static ct_status carry_out(ct_session *session, const char *text, ct_error *error)
{
    ct_cursor cursor = {.text = text, .line = 1};
    ct_status status = CT_OK;

    while (status == CT_OK && text[cursor.next] != '\0') {
        ct_statement *statement;

        status = ct_parse(&cursor, false, &statement, error);
        if (status != CT_OK)
            break;
        status = ct_carrier(statement) == CT_SESSION ? ct_run(session, statement, error)
                                                     : ct_apply(session, statement, error);
        ct_statement_free(statement);
        fputs(ct_remarks(session), stderr);
    }
    return status;
}

/* the value of an expression at the end of the last run */
static ct_status value_of(ct_session *session, const char *question, double *out, ct_error *error)
{
    ct_cursor cursor = {.text = question, .line = 1};
    ct_statement *statement;
    ct_status status = ct_parse(&cursor, false, &statement, error);

    if (status != CT_OK)
        return status;
    status = ct_value(session, ct_operand(statement, 0), NULL, out, error);
    ct_statement_free(statement);
    return status;
}

/* the largest value of a column of the run's table */
static ct_status print_largest(ct_session *session, ct_error *error)
{
    double *values, largest = 0;
    int rows, columns;
    char **names;
    ct_status status = ct_table(session, NULL, 0, 0, &values, &rows, &columns, &names, error);

    if (status != CT_OK)
        return status;
    for (int row = 0; row < rows; row++)
        if (values[row * columns + 1] > largest)
            largest = values[row * columns + 1];
    printf("%s is %.3f at most, in %d rows\n", names[1], largest, rows);
    ct_free(values);
    ct_words_free(names);
    return CT_OK;
}

static void print_figures(const ct_session *session)
{
    ct_figures figures;

    if (ct_run_figures(session, 0, &figures))
        printf("%s: %" PRId64 " steps up to %g s, energy kept to %.1g J\n", figures.method,
               figures.steps, figures.to, figures.energy_drift);
}

int main(void)
{
    static const char model[] = "scene planar; gravity [0, -9.81]\n"
                                "body bob mass=1 inertia=0.01\n"
                                "arm top bob [0, 0.5]\n"
                                "revolute h ground top\n"
                                "tree h\n"
                                "init h = 30 deg\n";
    const ct_hooks hooks = {.stop = is_stopped};
    ct_session *session = ct_session_new(&hooks);
    ct_error error;
    ct_status status;
    double angle;

    if (session == NULL)
        return 1;
    (void)signal(SIGINT, on_interrupt);
    status = carry_out(session, model, &error);
    if (status == CT_OK)
        status = carry_out(session, "simulate 1 every=0.01", &error);
    if (status == CT_OK)
        status = value_of(session, "print h", &angle, &error);
    if (status == CT_OK) {
        printf("%.6f rad\n", angle);
        status = print_largest(session, &error);
    }
    print_figures(session); /* also of a run that was stopped */
    if (status != CT_OK) {
        fprintf(stderr, "line %d, column %d: %s\n", error.line, error.column, error.message);
        if (error.hint[0] != '\0')
            fprintf(stderr, "hint: %s\n", error.hint);
    }
    ct_session_free(session);
    return status == CT_OK ? 0 : 1;
}
