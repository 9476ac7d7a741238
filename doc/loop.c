/* A controller in the loop: this program sets a torque a hundred times a second, from the measured
 * angle and rate, and swings a hanging rod up. The run ends once the rod stands upright. */
#include <cotree.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char rod[] =
    "scene planar; gravity [0, -9.81]\n"
    "body b mass=1 inertia=1/12; arm foot b [0, 1/2]; revolute h ground foot\n"
    "input U1 u 0 period=10 ms; actuator a1 h torque=U1.v\n";

typedef struct Controller {
    double goal;  /* rad */
    double sum;   /* of errors, rad*s */
    int standing; /* consecutive rows */
} Controller;

/* the torque up to the next instant, at most 40 N*m */
static bool control(void *context, const char *name, double t, const double *values, double *torque)
{
    Controller *c = context;
    const double error = c->goal - values[0];

    (void)t;
    c->sum += 0.01 * error;
    if (strcmp(name, "U1") == 0)
        *torque = fmax(-40, fmin(40, 60 * error + 40 * c->sum - 12 * values[1]));
    return false;
}

static bool is_standing(void *context, double t, const double *values)
{
    Controller *c = context;

    (void)t;
    c->standing = fabs(values[0] - c->goal) < 1e-3 && fabs(values[1]) < 1e-3 ? c->standing + 1 : 0;
    return c->standing == 10;
}

/* the next statement of a text; NULL: there is none, or it is wrong */
static ct_statement *next_of(const char *text, ct_cursor *cursor, ct_error *error)
{
    ct_statement *statement = NULL;

    if (text[cursor->next] == '\0' || ct_parse(cursor, false, &statement, error) != CT_OK)
        return NULL;
    return statement;
}

int main(void)
{
    ct_session *session = ct_session_new(NULL);
    ct_cursor cursor = {.text = rod, .line = 1}, asked = {.text = "table h h'", .line = 1};
    ct_error error = {.status = CT_OK};
    ct_statement *statement;
    const ct_expression *items[2];
    Controller controller = {.goal = 3.14159265358979};
    ct_run_options options = {.duration = 20,
                              .every = 0.05,
                              .items = items,
                              .item_count = 2,
                              .context = &controller,
                              .row = is_standing,
                              .input = control};
    ct_column *columns;
    int count, rows;

    while ((statement = next_of(rod, &cursor, &error)) != NULL) {
        (void)ct_apply(session, statement, &error);
        ct_statement_free(statement);
    }
    statement = next_of(asked.text, &asked, &error);
    for (int i = 0; statement != NULL && i < 2; i++)
        items[i] = ct_operand(statement, i);
    if (statement == NULL || ct_simulate(session, &options, &error) == CT_FAILED ||
        ct_columns(session, items, 2, 0, &columns, &count, &rows, &error) != CT_OK) {
        fprintf(stderr, "%s\n", error.message);
        return 1;
    }
    printf("%s is %.2f %s after %.1f %s\n", columns[1].name, columns[1].values[rows - 1],
           columns[1].unit, columns[0].values[rows - 1], columns[0].unit);
    ct_columns_free(columns);
    ct_statement_free(statement);
    ct_session_free(session);
    return 0;
}
