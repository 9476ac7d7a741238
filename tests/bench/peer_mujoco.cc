// peer_mujoco.cc: a model by MuJoCo
//
// peer_mujoco MODEL.xml: accelerations and joint torques of a tree, at the angles and rates of
// bench_dynamics.c, in two places in turn.
// peer_mujoco MODEL.xml SECONDS ROWS STEPS [SPEED...]: a run from angles of 0 by its Runge-Kutta
// method, in so many steps a row; the joints' angles at each row, and the processor's time.
// Built by peers.py and races.py.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <mujoco/mujoco.h>
#include <vector>

static double now()
{
    timespec at;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &at);
    return (double)at.tv_sec + 1e-9 * (double)at.tv_nsec;
}

static void place(const mjModel *model, mjData *data, int turn)
{
    for (int i = 0; i < model->nq; i++)
        data->qpos[i] = sin(1 + 1.7 * i) + (i == 0 && turn % 2 == 1 ? 0.1 : 0);
    for (int j = 0; j < model->nv; j++)
        data->qvel[j] = cos(2 + 1.3 * j);
}

static double least(const mjModel *model, mjData *data, void (*call)(const mjModel *, mjData *))
{
    const int few = 2 + 2 * (200 / (10 + model->nv));
    double best = 1e300;

    for (int turn = 0; turn < 300; turn++) {
        const double begin = now();

        for (int i = 0; i < few; i++) {
            data->qpos[0] = sin(1) + (i % 2 == 1 ? 0.1 : 0);
            call(model, data);
        }
        best = fmin(best, (now() - begin) / few);
    }
    return 1e9 * best;
}

static void run(mjModel *model, mjData *data, double seconds, int rows, int steps)
{
    std::vector<double> angles;
    double taken = now();

    model->opt.integrator = mjINT_RK4;
    model->opt.timestep = seconds / rows / steps;
    for (int e = 0; e < model->neq; e++)
        model->eq_solref[mjNREF * e] = 2 * model->opt.timestep; /* as stiff as steps allow */
    angles.reserve((size_t)rows * model->nq);
    for (int row = 0; row < rows; row++) {
        for (int step = 0; step < steps; step++)
            mj_step(model, data);
        angles.insert(angles.end(), data->qpos, data->qpos + model->nq);
    }
    taken = now() - taken;
    for (size_t i = 0; i < angles.size(); i++)
        printf("%.15g%c", angles[i], (i + 1) % model->nq == 0 ? '\n' : ' ');
    printf("# ms %.6g\n", 1e3 * taken);
}

int main(int argc, char **argv)
{
    char error[500] = "";
    mjModel *model = argc >= 2 ? mj_loadXML(argv[1], NULL, error, sizeof error) : NULL;
    mjData *data = model != NULL ? mj_makeData(model) : NULL;

    if (data == NULL) {
        printf("# mujoco: %s\n", error);
        return 1;
    }
    if (argc > 4) {
        for (int j = 0; j < model->nv && 5 + j < argc; j++)
            data->qvel[j] = atof(argv[5 + j]);
        run(model, data, atof(argv[2]), atoi(argv[3]), atoi(argv[4]));
        mj_deleteData(data);
        mj_deleteModel(model);
        return 0;
    }
    place(model, data, 0);
    mj_forward(model, data);
    printf("# u'");
    for (int j = 0; j < model->nv; j++)
        printf(" %.15g", data->qacc[j]);
    printf("\nforward %.6g\n", least(model, data, mj_forward));
    place(model, data, 0);
    for (int j = 0; j < model->nv; j++)
        data->qacc[j] = sin(3 + 0.7 * j);
    printf("inverse %.6g\n", least(model, data, mj_inverse));
    place(model, data, 0);
    mj_inverse(model, data);
    printf("# tau");
    for (int j = 0; j < model->nv; j++)
        printf(" %.15g", data->qfrc_inverse[j]);
    printf("\n");
    mj_deleteData(data);
    mj_deleteModel(model);
    return 0;
}
