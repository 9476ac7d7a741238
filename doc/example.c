/* A pendulum in libcotree: build it, run it, and print where it is after a second. */
#include <cotree.h>

#include <stdio.h>

/* carry out one line: the model takes what builds, ct_run() what runs */
static ct_status line_do(ct_session *session, const char *line, ct_error *error)
{
    ct_cursor cursor = {.text = line, .line = 1};

    while (line[cursor.next] != '\0') {
        ct_statement *statement;
        ct_status status = ct_parse(&cursor, false, &statement, error);

        if (status != CT_OK)
            return status;
        status = ct_apply(session, statement, error);
        if (status == CT_NOT_MINE)
            status = ct_run(session, statement, error);
        ct_statement_free(statement);
        if (status != CT_OK)
            return status;
    }
    return CT_OK;
}

int main(void)
{
    static const char *const lines[] = {
        "scene planar; gravity [0, -9.81]",
        "body bob mass=1 inertia=0.01",
        "arm top bob [0, 0.5]",
        "revolute h ground top",
        "init h = 30 deg",
        "simulate 1 every=0.01",
    };
    ct_session *session = ct_session_new(NULL);
    ct_error error;
    ct_status status = CT_OK;

    for (size_t i = 0; i < sizeof lines / sizeof *lines && status == CT_OK; i++)
        status = line_do(session, lines[i], &error);

    if (status == CT_OK) {
        ct_cursor question = {.text = "print h", .line = 1};
        ct_statement *statement;
        double angle;

        status = ct_parse(&question, false, &statement, &error);
        if (status == CT_OK) {
            status = ct_value(session, ct_operand(statement, 0), NULL, &angle, &error);
            ct_statement_free(statement);
        }
        if (status == CT_OK)
            printf("%.6f rad\n", angle);
    }
    if (status != CT_OK)
        fprintf(stderr, "%s\n", error.message);
    ct_session_free(session);
    return status == CT_OK ? 0 : 1;
}
