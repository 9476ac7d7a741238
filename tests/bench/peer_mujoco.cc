// peer_mujoco.cc: accelerations and joint torques of a tree by MuJoCo: peer_mujoco MODEL.xml
//
// At the angles and rates of bench_dynamics.c, in two places in turn. Built by peers.py.
#include <cmath>
#include <cstdio>
#include <ctime>
#include <mujoco/mujoco.h>

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

int main(int argc, char **argv)
{
    char error[500] = "";
    mjModel *model = argc == 2 ? mj_loadXML(argv[1], NULL, error, sizeof error) : NULL;
    mjData *data = model != NULL ? mj_makeData(model) : NULL;

    if (data == NULL) {
        printf("# mujoco: %s\n", error);
        return 1;
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
