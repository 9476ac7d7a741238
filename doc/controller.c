/* A controller that computes its torques with the model: it moves an arm of two links with a load
 * to two angles. The model is formed once, at the start; the loop allocates nothing. */
#include <cotree.h>

#include <stdio.h>

static const char arm[] = "scene planar; gravity [0, -9.81]\n"
                          "L = 0.4 m; payload = 2 kg; T1 = 0; T2 = 0\n"
                          "body m1 mass=3 inertia=0.05; body m2 mass=payload inertia=0.02\n"
                          "arm r1 m1 [-L/2, 0]; arm r2 m1 [L/2, 0]; arm r3 m2 [-L/2, 0]\n"
                          "revolute h1 ground r1; revolute h2 r2 r3\n"
                          "actuator a1 h1 torque=T1; actuator a2 h2 torque=T2\n";

/* the model that the statements of a text build; NULL: error has the reason */
static ct_model *model_of(const char *text, ct_error *error)
{
    ct_session *session = ct_session_new(NULL);
    ct_cursor cursor = {.text = text, .line = 1};
    ct_model *model = NULL;
    ct_status status = session != NULL ? CT_OK : CT_FAILED;

    while (status == CT_OK && text[cursor.next] != '\0') {
        ct_statement *statement;

        status = ct_parse(&cursor, false, &statement, error);
        if (status != CT_OK)
            break;
        status = ct_apply(session, statement, error);
        ct_statement_free(statement);
    }
    if (status == CT_OK)
        (void)ct_model_new(session, NULL, &model, error);
    ct_session_free(session);
    return model;
}

/* T = M a - F, with F at zero torque */
static void find_torques(const ct_model *model, ct_evaluator *plan, double *p, const double *y)
{
    static const double goal[2] = {0.8, -0.5}, t = 0;
    const int T1 = ct_model_find(model, CT_PARAMETERS, "T1"),
              T2 = ct_model_find(model, CT_PARAMETERS, "T2");
    double M[4], F[2], a[2];

    p[T1] = p[T2] = 0;
    ct_evaluate(plan, ct_model_function(model, "mass", NULL, NULL), p, &t, y, NULL, M);
    ct_evaluate(plan, ct_model_function(model, "forces", NULL, NULL), p, &t, y, NULL, F);
    for (int i = 0; i < 2; i++)
        a[i] = 100 * (goal[i] - y[i]) - 20 * y[2 + i];
    p[T1] = M[0] * a[0] + M[1] * a[1] - F[0];
    p[T2] = M[2] * a[0] + M[3] * a[1] - F[1];
}

int main(void)
{
    ct_error error;
    ct_model *model = model_of(arm, &error);
    ct_evaluator *plan, *plant;
    double p[4], y[4], s[2], rates[4];

    if (model == NULL) {
        fprintf(stderr, "line %d: %s\n", error.line, error.message);
        return 1;
    }
    plan = ct_evaluator_new(model);
    plant = ct_evaluator_new(model); /* one evaluator would be enough for one thread */
    ct_model_start(model, p, y, s);
    for (int k = 0; plan != NULL && plant != NULL && k < 300000; k++) {
        const double t = 1e-5 * k;

        if (k % 100 == 0)
            find_torques(model, plan, p, y);
        if (ct_rates(plant, p, &t, y, s, rates) != CT_OK)
            return 1;
        for (int i = 0; i < 2; i++) { /* first speeds, then angles from the new speeds */
            y[2 + i] += 1e-5 * rates[2 + i];
            y[i] += 1e-5 * y[2 + i];
        }
    }
    printf("%s %.4f, %s %.4f %s\n", ct_model_name(model, CT_STATE, 0), y[0],
           ct_model_name(model, CT_STATE, 1), y[1], ct_model_unit(model, CT_STATE, 1));
    ct_evaluator_free(plan);
    ct_evaluator_free(plant);
    ct_model_free(model);
    return 0;
}
