// peer_simbody.cc: a tree by Simbody
//
// peer_simbody < TREE: accelerations and joint torques at the angles and rates of bench_dynamics.c.
// peer_simbody METHOD SECONDS ACCURACY < TREE: a run from angles of 0 at rest by merson, fehlberg
// or adams (of CPODES); the joints' angles at the end, and the processor's time. TREE has a line a
// body, as peers.py writes it: parent, axis, place of the joint in the parent's and in its own
// frame, mass, principal moments; the first line is gravity. Built by peers.py and races.py.
#include <Simbody.h>
#include <ctime>
#include <iostream>
#include <memory>
#include <string>

using namespace SimTK;

static double now()
{
    timespec at;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &at);
    return at.tv_sec + 1e-9 * at.tv_nsec;
}

static Vec3 vector()
{
    Vec3 v;

    std::cin >> v[0] >> v[1] >> v[2];
    return v;
}

static std::unique_ptr<Integrator> method_of(const std::string &name, const MultibodySystem &system)
{
    if (name == "merson")
        return std::unique_ptr<Integrator>(new RungeKuttaMersonIntegrator(system));
    if (name == "fehlberg")
        return std::unique_ptr<Integrator>(new RungeKuttaFeldbergIntegrator(system));
    return std::unique_ptr<Integrator>(new CPodesIntegrator(system, CPodes::Adams));
}

static void run(const MultibodySystem &system, const State &start, char **how)
{
    const double seconds = std::stod(how[1]);
    const double begin = now();
    const std::unique_ptr<Integrator> method = method_of(how[0], system);

    method->setAccuracy(std::stod(how[2]));
    method->setInternalStepLimit(100000000);
    method->initialize(start);
    while (method->getTime() < seconds)
        method->stepTo(seconds);
    const double taken = now() - begin;

    std::cout.precision(15);
    for (int i = 0; i < method->getState().getNQ(); i++)
        std::cout << method->getState().getQ()[i] << ' ';
    std::cout << "\n# ms " << 1e3 * taken << '\n';
}

int main(int argc, char **argv)
{
    MultibodySystem system;
    SimbodyMatterSubsystem matter(system);
    GeneralForceSubsystem forces(system);
    Force::UniformGravity gravity(forces, matter, vector());
    Array_<MobilizedBody> bodies;
    int parent;

    while (std::cin >> parent) {
        const Vec3 axis = vector(), place = vector(), own = vector();
        const Rotation turn(UnitVec3(axis), ZAxis);
        double mass;

        std::cin >> mass;
        const Vec3 moments = vector();
        const Body::Rigid body(MassProperties(mass, Vec3(0), Inertia(moments)));
        MobilizedBody before = parent < 0 ? MobilizedBody(matter.Ground()) : bodies[parent];

        bodies.push_back(
            MobilizedBody::Pin(before, Transform(turn, place), body, Transform(turn, own)));
    }
    State state = system.realizeTopology();

    if (argc == 4) {
        run(system, state, argv + 1);
        return 0;
    }
    const int n = state.getNU(), few = 2 + 2 * (200 / (10 + n));
    Vector asked(n), torques;

    for (int i = 0; i < n; i++) {
        state.updQ()[i] = std::sin(1 + 1.7 * i);
        state.updU()[i] = std::cos(2 + 1.3 * i);
        asked[i] = std::sin(3 + 0.7 * i);
    }
    system.realize(state, Stage::Acceleration);
    const Vector found = state.getUDot();

    std::cout.precision(15);
    std::cout << "# u'";
    for (int j = 0; j < n; j++)
        std::cout << ' ' << found[j];
    std::cout << '\n';
    for (int what = 0; what < 2; what++) {
        double best = 1e300;

        for (int turn = 0; turn < (n > 100 ? 30 : 200); turn++) {
            const double begin = now();

            for (int i = 0; i < few; i++) {
                state.updQ()[0] = std::sin(1.0) + (i % 2 == 1 ? 0.1 : 0);
                system.realize(state, what == 0 ? Stage::Acceleration : Stage::Dynamics);
                if (what == 1)
                    matter.calcResidualForceIgnoringConstraints(
                        state, Vector(0), system.getRigidBodyForces(state, Stage::Dynamics), asked,
                        torques);
            }
            best = std::min(best, (now() - begin) / few);
        }
        std::cout << (what == 0 ? "forward " : "inverse ") << 1e9 * best << '\n';
    }
    state.updQ()[0] = std::sin(1.0);
    system.realize(state, Stage::Dynamics);
    matter.calcResidualForceIgnoringConstraints(
        state, Vector(0), system.getRigidBodyForces(state, Stage::Dynamics), asked, torques);
    std::cout << "# tau";
    for (int j = 0; j < n; j++)
        std::cout << ' ' << torques[j];
    std::cout << '\n';
    return 0;
}
