// simbody_oracle.cpp: accelerations and reactions of a rigid mechanism, by Simbody
//
// Reads statements of the command language that tests/unit/spatial.h writes (gravity, body,
// arm, joints) and lines `state BODY x y z q0 q1 q2 q3 vx vy vz wx wy wz` in ground axes;
// prints lines `b0.ax VALUE`. The first joint that ends on a body becomes its mobilizer, each
// further one a set of constraints. Axes are turned so that they are Simbody's.
#include <Simbody.h>

#include <iostream>
#include <map>
#include <memory>
#include <sstream>

using namespace SimTK;
using std::string;

struct Frame {
    string body;
    Transform place;
};

struct Joint {
    string name, kind;
    Frame tail, head; // turned to Simbody's axes
    double pitch = 0;
    int mobilized = -1;          // the body it carries, or
    std::vector<int> constraints; // what it enforces
};

struct State13 {
    double at[13];
};

struct Mechanism {
    MultibodySystem system;
    SimbodyMatterSubsystem matter{system};
    GeneralForceSubsystem forces{system};
    std::map<string, Frame> frames;
    std::map<string, Body::Rigid> bodies;
    std::map<string, MobilizedBodyIndex> carried;
    std::map<string, State13> states;
    std::vector<string> order;
    std::vector<Joint> joints;

    Mechanism()
    {
        frames["ground"] = {"ground", Transform()};
        carried["ground"] = MobilizedBodyIndex(0);
    }
};

static const char *const axis_names[] = {"x", "y", "z"};

static double number(std::istringstream &in)
{
    double value = NaN;

    if (!(in >> value))
        throw std::runtime_error("a number is missing");
    return value;
}

static Vec3 vector_of(std::istringstream &in)
{
    double x = number(in), y = number(in);

    return Vec3(x, y, number(in));
}

// x, -y or three numbers
static UnitVec3 axis_of(std::istringstream &in)
{
    std::streampos here = in.tellg();
    string word;

    in >> word;
    for (int i = 0; i < 3; i++) {
        Vec3 unit(0);

        unit[i] = 1;
        if (word == axis_names[i])
            return UnitVec3(unit);
        if (word == string("-") + axis_names[i])
            return UnitVec3(-unit);
    }
    in.seekg(here);
    return UnitVec3(vector_of(in));
}

// turns x 0.3 z -1, from left to right
static Rotation turns_of(std::istringstream &in)
{
    Rotation whole;
    string word;

    while (in >> word) {
        int axis = word == "x" ? 0 : word == "y" ? 1 : 2;

        whole = whole * Rotation(number(in), CoordinateAxis(axis));
    }
    return whole;
}

static void read_body(Mechanism &m, const string &name, std::istringstream &in)
{
    string word;
    double mass = 0, I[6] = {0};

    while (in >> word)
        if (word == "mass")
            mass = number(in);
        else if (word == "inertia")
            for (double &entry : I)
                entry = number(in);
    m.bodies[name] =
        Body::Rigid(MassProperties(mass, Vec3(0), Inertia(I[0], I[1], I[2], I[3], I[4], I[5])));
    m.frames[name] = {name, Transform()};
    m.order.push_back(name);
}

static void read_arm(Mechanism &m, const string &name, std::istringstream &in)
{
    string from, word;
    Transform place;

    in >> from;
    place.updP() = vector_of(in);
    if (in >> word && word == "rotation")
        place.updR() = turns_of(in);
    m.frames[name] = {m.frames.at(from).body, m.frames.at(from).place * place};
}

static void carry(Mechanism &m, Joint &joint, MobilizedBody &parent)
{
    const Transform &F = joint.tail.place, &M = joint.head.place;
    const Body::Rigid &body = m.bodies.at(joint.head.body);
    const string &kind = joint.kind;
    MobilizedBody made;

    if (kind == "revolute")
        made = MobilizedBody::Pin(parent, F, body, M);
    else if (kind == "prismatic")
        made = MobilizedBody::Slider(parent, F, body, M);
    else if (kind == "cylindrical")
        made = MobilizedBody::Cylinder(parent, F, body, M);
    else if (kind == "universal")
        made = MobilizedBody::Universal(parent, F, body, M);
    else if (kind == "spherical")
        made = MobilizedBody::Ball(parent, F, body, M);
    else if (kind == "planarjoint")
        made = MobilizedBody::Planar(parent, F, body, M);
    else if (kind == "screw")
        made = MobilizedBody::Screw(parent, F, body, M, joint.pitch / (2 * Pi));
    else if (kind == "free")
        made = MobilizedBody::Free(parent, F, body, M);
    else if (kind == "weld")
        made = MobilizedBody::Weld(parent, F, body, M);
    else
        throw std::runtime_error("no mobilizer for " + kind);
    joint.mobilized = made.getMobilizedBodyIndex();
    m.carried[joint.head.body] = made.getMobilizedBodyIndex();
}

// what keeps the tip on the tail: directions of the tail that it can't go along, and pairs of
// axes, tail's and head's, that stay at right angles
static void constrain(Joint &joint, MobilizedBody &tail, MobilizedBody &head)
{
    static const struct {
        const char *kind;
        std::vector<int> along;
        std::vector<std::pair<int, int>> across;
    } rows[] = {{"spherical", {0, 1, 2}, {}},
                {"universal", {0, 1, 2}, {{0, 1}}},
                {"revolute", {0, 1, 2}, {{0, 2}, {1, 2}}},
                {"cylindrical", {0, 1}, {{0, 2}, {1, 2}}},
                {"planarjoint", {2}, {{0, 2}, {1, 2}}},
                {"prismatic", {1, 2}, {{0, 1}, {1, 2}, {2, 0}}},
                {"weld", {0, 1, 2}, {{0, 1}, {1, 2}, {2, 0}}}};
    const Transform &F = joint.tail.place, &M = joint.head.place;

    for (const auto &row : rows) {
        if (joint.kind != row.kind)
            continue;
        for (int i : row.along) {
            UnitVec3 normal = F.R()(i);
            Constraint::PointInPlane made(tail, normal, dot(normal, F.p()), head, M.p());

            joint.constraints.push_back(made.getConstraintIndex());
        }
        for (const auto &pair : row.across) {
            Constraint::ConstantAngle made(tail, F.R()(pair.first), head, M.R()(pair.second));

            joint.constraints.push_back(made.getConstraintIndex());
        }
        return;
    }
    throw std::runtime_error("no constraint for " + joint.kind);
}

static void read_joint(Mechanism &m, const string &kind, const string &name, std::istringstream &in)
{
    string tail, head, word;
    Joint joint;
    Rotation axes;

    in >> tail >> head;
    joint.name = name;
    joint.kind = kind;
    joint.tail = m.frames.at(tail);
    joint.head = m.frames.at(head);
    while (in >> word)
        if (word == "axes") {
            UnitVec3 first = axis_of(in);

            axes = Rotation(first, XAxis, axis_of(in), YAxis);
        } else if (word == "axis" || word == "normal") {
            axes = Rotation(axis_of(in), CoordinateAxis(kind == "prismatic" ? 0 : 2));
        } else if (word == "pitch") {
            joint.pitch = number(in);
        }
    joint.tail.place = joint.tail.place * Transform(axes);
    joint.head.place = joint.head.place * Transform(axes);

    MobilizedBody &parent = m.matter.updMobilizedBody(m.carried.at(joint.tail.body));
    auto other = m.carried.find(joint.head.body);

    if (other == m.carried.end())
        carry(m, joint, parent);
    else
        constrain(joint, parent, m.matter.updMobilizedBody(other->second));
    m.joints.push_back(joint);
}

static void read_line(Mechanism &m, string line)
{
    string verb, name;

    for (char &c : line)
        if (strchr("[],=()*", c) != nullptr)
            c = ' ';
    std::istringstream in(line);
    if (!(in >> verb))
        return;
    if (verb == "gravity") {
        Force::UniformGravity(m.forces, m.matter, vector_of(in));
        return;
    }
    in >> name;
    if (verb == "body")
        read_body(m, name, in);
    else if (verb == "arm")
        read_arm(m, name, in);
    else if (verb == "state")
        for (double &value : m.states[name].at)
            value = number(in);
    else
        read_joint(m, verb, name, in);
}

static Transform pose_of(const State13 &s)
{
    return Transform(Rotation(Quaternion(Vec4(s.at[3], s.at[4], s.at[5], s.at[6]))),
                     Vec3(s.at[0], s.at[1], s.at[2]));
}

static SpatialVec motion_of(const State13 &s)
{
    return SpatialVec(Vec3(s.at[10], s.at[11], s.at[12]), Vec3(s.at[7], s.at[8], s.at[9]));
}

// the coordinates and speeds of mobilizers that put bodies where and how they are said to be
static void fit(const Mechanism &m, State &state)
{
    static const State13 rest = {{0, 0, 0, 1, 0, 0, 0}};

    for (const Joint &joint : m.joints) {
        if (joint.mobilized < 0)
            continue;
        const MobilizedBody &body = m.matter.getMobilizedBody(MobilizedBodyIndex(joint.mobilized));
        const State13 &s = m.states.at(joint.head.body);
        bool on_ground = joint.tail.body == "ground";
        const State13 &of_parent = on_ground ? rest : m.states.at(joint.tail.body);
        Transform F = pose_of(of_parent) * joint.tail.place, M = pose_of(s) * joint.head.place;
        SpatialVec P = motion_of(of_parent), B = motion_of(s);
        Vec3 v_F = P[1] + P[0] % (M.p() - pose_of(of_parent).p());
        Vec3 v_M = B[1] + B[0] % (M.p() - pose_of(s).p());

        body.setQToFitTransform(state, ~F * M);
        m.system.realize(state, Stage::Position);
        body.setUToFitVelocity(state, SpatialVec(~F.R() * (B[0] - P[0]), ~F.R() * (v_M - v_F)));
    }
    m.system.realize(state, Stage::Velocity);
    for (const string &name : m.order) {
        const MobilizedBody &body = m.matter.getMobilizedBody(m.carried.at(name));
        const State13 &s = m.states.at(name);
        SpatialVec off = body.getBodyVelocity(state) - motion_of(s);
        Transform place = pose_of(s);
        double away = (body.getBodyOriginLocation(state) - place.p()).norm() +
                      (~place.R() * body.getBodyRotation(state)).convertRotationToAngleAxis()[0];

        if (std::abs(away) > 1e-7 || off[0].norm() + off[1].norm() > 1e-7)
            throw std::runtime_error(name + " can't be put where it is said to be");
    }
}

static void print(const string &name, const char *const members[6], Vec3 first, Vec3 second)
{
    for (int i = 0; i < 3; i++)
        std::cout << name << '.' << members[i] << ' ' << first[i] << '\n'
                  << name << '.' << members[3 + i] << ' ' << second[i] << '\n';
}

// force and moment on the tip about its origin, ground axes
static SpatialVec reaction_of(const Mechanism &m, const Joint &joint, const State &state)
{
    if (joint.mobilized >= 0)
        return m.matter.getMobilizedBody(MobilizedBodyIndex(joint.mobilized))
            .findMobilizerReactionOnBodyAtMInGround(state);

    const MobilizedBody &head = m.matter.getMobilizedBody(m.carried.at(joint.head.body));
    Vec3 arm = head.getBodyRotation(state) * joint.head.place.p();
    SpatialVec sum(Vec3(0), Vec3(0));

    for (int index : joint.constraints) {
        const Constraint &constraint = m.matter.getConstraint(ConstraintIndex(index));
        Vector_<SpatialVec> onto = constraint.getConstrainedBodyForcesAsVector(state);

        // constraint forces stand on the left-hand side of Simbody's equations: minus
        for (ConstrainedBodyIndex b(0); b < constraint.getNumConstrainedBodies(); b++)
            if (constraint.getMobilizedBodyFromConstrainedBody(b).getMobilizedBodyIndex() ==
                head.getMobilizedBodyIndex())
                sum -= onto[b];
    }
    sum[0] -= arm % sum[1];
    return sum;
}

int main()
{
    static const char *const of_body[] = {"ax", "ay", "az", "alphax", "alphay", "alphaz"};
    static const char *const of_joint[] = {"fx", "fy", "fz", "tx", "ty", "tz"};

    try {
        Mechanism m;
        string line;

        while (std::getline(std::cin, line))
            read_line(m, line);
        State state = m.system.realizeTopology();
        m.system.realizeModel(state);
        fit(m, state);
        m.system.realize(state, Stage::Acceleration);
        std::cout.precision(17);
        for (const string &name : m.order) {
            SpatialVec a =
                m.matter.getMobilizedBody(m.carried.at(name)).getBodyAcceleration(state);

            print(name, of_body, a[1], a[0]);
        }
        for (const Joint &joint : m.joints) {
            SpatialVec reaction = reaction_of(m, joint, state);

            print(joint.name, of_joint, reaction[1], reaction[0]);
        }
    } catch (const std::exception &fault) {
        std::cerr << fault.what() << '\n';
        return 1;
    }
    return 0;
}
