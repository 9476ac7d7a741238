/* robot_text.h: models of robots and chains, for benchmarks */
#ifndef COTREE_TESTS_BENCH_ROBOT_TEXT_H
#define COTREE_TESTS_BENCH_ROBOT_TEXT_H

#include "base/text.h"

/* Six joints: lengths, masses and inertias of the UR5 as its maker's description of it has them, in
 * the position where the arm lies level. */
static const char robot_6r[] =
    "gravity [0, 0, -9.81]\n"
    "arm base ground [0, 0, 0.089159]\n"
    "body l1 mass=3.7 inertia=[0.010267495893, 0.010267495893, 0.00666]\n"
    "body l2 mass=8.393 inertia=[0.0151074, 0.22689067591, 0.22689067591]\n"
    "body l3 mass=2.275 inertia=[0.004095, 0.049443313556, 0.049443313556]\n"
    "body l4 mass=1.219 inertia=[0.111172755531, 0.111172755531, 0.21942]\n"
    "body l5 mass=1.219 inertia=[0.111172755531, 0.111172755531, 0.21942]\n"
    "body l6 mass=0.1879 inertia=[0.0171364731454, 0.033822, 0.0171364731454]\n"
    "arm a1 l1 [0, 0.13585, 0]; arm o2 l2 [-0.28, 0, 0]; arm a2 o2 [0.425, -0.1197, 0]\n"
    "arm o3 l3 [-0.25, 0, 0]; arm a3 o3 [0.39225, 0, 0]; arm a4 l4 [0, 0.093, 0]\n"
    "arm a5 l5 [0, 0, -0.09465]\n"
    "revolute j1 base l1 axis=z; revolute j2 a1 o2 axis=y; revolute j3 a2 o3 axis=y\n"
    "revolute j4 a3 l4 axis=y; revolute j5 a4 l5 axis=-z; revolute j6 a5 l6 axis=y\n"
    "tree joint\n";

/* rods of 1 m and 1 kg on revolute joints in a plane */
static char *robot_chain(int links)
{
    Text text = {0};

    text_add(&text, "scene planar\ngravity [0, -9.81]\n");
    for (int i = 0; i < links; i++) {
        text_addf(&text, "body b%d mass=1 inertia=1/12\narm s%d b%d [-0.5, 0]\n", i, i, i);
        text_addf(&text, "arm e%d b%d [0.5, 0]\n", i, i);
        if (i == 0)
            text_add(&text, "revolute h0 ground s0\n");
        else
            text_addf(&text, "revolute h%d e%d s%d\n", i, i - 1, i);
    }
    text_add(&text, "tree joint\n");
    return text_done(&text);
}

#endif
