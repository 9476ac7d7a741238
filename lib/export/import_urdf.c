/* import_urdf.c: a robot in the Unified Robot Description Format
 *
 * A link is a frame, at the joint that carries it, and a mass somewhere in it. Here it is a body,
 * at its mass centre and parallel to the link's frame. If their origins differ, an arm,
 * NAME_origin, leads from the body to that frame. A link without mass that is fixed to another is
 * an arm of that one. The root of the tree is fixed to ground: URDF defines neither the support of
 * its root nor gravity.
 *
 * R(rpy) = Rz(yaw) Ry(pitch) Rx(roll), from the link's frame to the frame that contains it. */
#include "export/xml.h"

#include "algebra/matrix3.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct ImportUrdfPose {
    double at[3];  /* m */
    double rpy[3]; /* rad */
} ImportUrdfPose;

typedef struct ImportUrdfLink {
    const Element *element;
    const char *name;  /* ours */
    const char *frame; /* ours, at its origin; NULL: not written yet */
    double mass;       /* kg */
    double centre[3];  /* m, in its frame */
    double inertia[6]; /* xx yy zz xy xz yz about the centre, in its axes, kg*m^2 */
    int joint;         /* that carries it; -1: none */
    int first_child;   /* joint; -1 */
} ImportUrdfLink;

typedef enum JointKind { REVOLUTE, PRISMATIC, FIXED, FLOATING, PLANAR } JointKind;

typedef struct Joint {
    const Element *element;
    const char *name; /* ours */
    JointKind kind;
    int parent, child; /* links */
    int next;          /* joint of the same parent; -1 */
    ImportUrdfPose origin;
    double axis[3];
    bool is_said;
} Joint;

typedef struct Urdf {
    Import *import;
    LIST(ImportUrdfLink) links;
    LIST(Joint) joints;
    Names *link_names, *joint_names; /* as in the file */
    Names *others;                   /* kinds of elements that are left out */
    LIST(int) counts;                /* by kind */
    LIST(int) lines;
    int limits; /* joints that have some */
    Diag *diag;
} Urdf;

enum { LINK = 'l', JOINT = 'j', OWN = 'o' }; /* spaces of names */

/* --- values --- */

/* `count` numbers between blanks, as the attribute's value; unchanged if absent */
static Status read_numbers(Urdf *u, const Element *element, const char *name, int count,
                           double *out)
{
    const char *text = element != NULL ? xml_attribute(element, name) : NULL;
    const char *at = text;

    for (int i = 0; text != NULL && i < count; i++) {
        char *end;

        out[i] = strtod(at, &end);
        if (end == at || !isfinite(out[i]))
            return import_refuse(u->import, element->line, u->diag, "%s=\"%.60s\" of %.40s: %s",
                                 name, text, element->name,
                                 count == 1 ? "a number is wanted" : "three numbers are wanted");
        at = end;
    }
    if (text != NULL && at[strspn(at, " \t\r\n")] != '\0')
        return import_refuse(u->import, element->line, u->diag, "%s=\"%.60s\" of %.40s: %s", name,
                             text, element->name,
                             count == 1 ? "a number is wanted" : "three numbers are wanted");
    return OK;
}

static Status read_pose(Urdf *u, const Element *element, ImportUrdfPose *out)
{
    const Element *origin = xml_child(element, "origin");

    TRY(read_numbers(u, origin, "xyz", 3, out->at));
    return read_numbers(u, origin, "rpy", 3, out->rpy);
}

static bool is_zero(const double v[3])
{
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

static const char *vector(Urdf *u, const double *v)
{
    return import_text(u->import, "[%s, %s, %s]", import_number(u->import, v[0]),
                       import_number(u->import, v[1]), import_number(u->import, v[2]));
}

/* An angle; a multiple of a quarter turn written to ten digits is read as the exact multiple. */
static const char *angle(Urdf *u, double value)
{
    static const char *const quarters[] = {"-pi", "-pi/2", "0", "pi/2", "pi"};
    const double quarter = round(value / M_PI_2);

    if (fabs(quarter) <= 2 && quarter != 0 && fabs(value - quarter * M_PI_2) < 1e-10)
        return quarters[(int)quarter + 2];
    return import_number(u->import, value);
}

/* " rotation=z(..)*y(..)*x(..)" without the turns that are none */
static const char *rotation(Urdf *u, const double rpy[3])
{
    const char *text = "";

    for (int i = 2; i >= 0; i--)
        if (rpy[i] != 0)
            text = import_text(u->import, "%s%s%c(%s)", text,
                               text[0] != '\0' ? "*" : " rotation=", "xyz"[i], angle(u, rpy[i]));
    return text;
}

static void turn_of(const double rpy[3], double R[9])
{
    static const double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

    matrix3_one(R);
    for (int i = 2; i >= 0; i--) {
        double one[9];

        matrix3_turn(axes[i], rpy[i], one);
        matrix3_times(R, one, R);
    }
}

/* --- links --- */

/* the inertia in axes of its own, turned into those of the link: R I R' */
static void turn_inertia(const double rpy[3], const double own[6], double out[6])
{
    const double I[9] = {own[0], own[3], own[4], own[3], own[1], own[5], own[4], own[5], own[2]};
    double R[9], back[9], turned[9];

    if (is_zero(rpy)) {
        memcpy(out, own, 6 * sizeof *out);
        return;
    }
    turn_of(rpy, R);
    matrix3_transpose(R, back);
    matrix3_times(R, I, turned);
    matrix3_times(turned, back, turned);
    memcpy(out, (double[]){turned[0], turned[4], turned[8], turned[1], turned[2], turned[5]},
           6 * sizeof *out);
    /* what quarter turns leave of an axis that is across is rounding */
    for (int i = 3; i < 6; i++)
        if (fabs(out[i]) < 1e-13 * (fabs(out[0]) + fabs(out[1]) + fabs(out[2])))
            out[i] = 0;
}

static Status read_inertial(Urdf *u, ImportUrdfLink *link)
{
    static const char *const names[] = {"ixx", "iyy", "izz", "ixy", "ixz", "iyz"};
    const Element *inertial = xml_child(link->element, "inertial");
    const Element *mass, *inertia;
    double own[6] = {0};
    ImportUrdfPose pose = {{0}, {0}};

    if (inertial == NULL)
        return OK;
    mass = xml_child(inertial, "mass");
    inertia = xml_child(inertial, "inertia");
    TRY(read_pose(u, inertial, &pose));
    TRY(read_numbers(u, mass, "value", 1, &link->mass));
    for (int i = 0; i < COUNT(names); i++)
        TRY(read_numbers(u, inertia, names[i], 1, &own[i]));
    memcpy(link->centre, pose.at, sizeof link->centre);
    turn_inertia(pose.rpy, own, link->inertia);
    return OK;
}

static Status read_link(Urdf *u, const Element *element)
{
    const char *name = xml_attribute(element, "name");
    ImportUrdfLink link = {.element = element, .joint = -1, .first_child = -1};

    if (name == NULL)
        return import_refuse(u->import, element->line, u->diag, "a link without a name");
    if (names_add(u->link_names, name) != u->links.count)
        return import_refuse(u->import, element->line, u->diag, "there is another link '%.60s'",
                             name);
    link.name = import_name(u->import, LINK, name);
    TRY(read_inertial(u, &link));
    LIST_PUSH(u->links, link);
    return OK;
}

/* --- joints --- */

static Status read_kind(Urdf *u, const Element *element, JointKind *out)
{
    static const struct {
        const char *name;
        JointKind kind;
    } kinds[] = {{"revolute", REVOLUTE}, {"continuous", REVOLUTE}, {"prismatic", PRISMATIC},
                 {"fixed", FIXED},       {"floating", FLOATING},   {"planar", PLANAR}};
    const char *type = xml_attribute(element, "type");

    for (int i = 0; type != NULL && i < COUNT(kinds); i++)
        if (strcmp(kinds[i].name, type) == 0) {
            *out = kinds[i].kind;
            return OK;
        }
    return import_refuse(u->import, element->line, u->diag, "a joint of type '%.40s'",
                         type != NULL ? type : "");
}

static Status find_end(Urdf *u, const Element *joint, const char *which, int *out)
{
    const Element *end = xml_child(joint, which);
    const char *name = end != NULL ? xml_attribute(end, "link") : NULL;

    *out = name != NULL ? names_find(u->link_names, name) : -1;
    if (*out >= 0)
        return OK;
    return import_refuse(u->import, joint->line, u->diag,
                         "the %s of this joint is no link: '%.60s'", which,
                         name != NULL ? name : "");
}

static Status read_joint(Urdf *u, const Element *element)
{
    const char *name = xml_attribute(element, "name");
    const Element *axis = xml_child(element, "axis");
    const int number = u->joints.count;
    Joint joint = {.element = element, .axis = {1, 0, 0}};

    if (name == NULL)
        return import_refuse(u->import, element->line, u->diag, "a joint without a name");
    if (names_add(u->joint_names, name) != number)
        return import_refuse(u->import, element->line, u->diag, "there is another joint '%.60s'",
                             name);
    joint.name = import_name(u->import, JOINT, name);
    TRY(read_kind(u, element, &joint.kind));
    TRY(find_end(u, element, "parent", &joint.parent));
    TRY(find_end(u, element, "child", &joint.child));
    TRY(read_pose(u, element, &joint.origin));
    TRY(read_numbers(u, axis, "xyz", 3, joint.axis));
    if (is_zero(joint.axis) && joint.kind != FIXED && joint.kind != FLOATING)
        return import_refuse(u->import, element->line, u->diag, "the axis of a joint is zero");
    assert(u->links.at != NULL); /* its ends were found */
    if (u->links.at[joint.child].joint >= 0)
        return import_refuse(u->import, element->line, u->diag, "link '%.60s' has two parents",
                             xml_attribute(u->links.at[joint.child].element, "name"));
    u->links.at[joint.child].joint = number;
    joint.next = u->links.at[joint.parent].first_child;
    u->links.at[joint.parent].first_child = number;
    LIST_PUSH(u->joints, joint);
    return OK;
}

/* --- statements --- */

static const char *own_name(Urdf *u, const char *name, const char *what)
{
    const char *both = import_text(u->import, "%s_%s", name, what);

    return import_name(u->import, OWN, both);
}

static bool has_inertia(const ImportUrdfLink *link)
{
    for (int i = 0; i < 6; i++)
        if (link->inertia[i] != 0)
            return true;
    return false;
}

/* the body of a link, and the frame at its origin */
static void write_body(Urdf *u, ImportUrdfLink *link)
{
    const double *I = link->inertia;
    const char *inertia = "";
    Import *import = u->import;

    if (has_inertia(link)) {
        inertia = vector(u, I);
        if (I[3] != 0 || I[4] != 0 || I[5] != 0)
            inertia = import_text(import, "%.*s, %s", (int)strlen(inertia) - 1, inertia,
                                  vector(u, I + 3) + 1);
        inertia = import_text(import, " inertia=%s", inertia);
    }
    import_add(import, link->element->line, "body %s mass=%s%s", link->name,
               import_number(import, link->mass), inertia);
    link->frame = link->name;
    if (is_zero(link->centre))
        return;
    link->frame = own_name(u, link->name, "origin");
    import_add(
        import, link->element->line, "arm %s %s %s", link->frame, link->name,
        vector(u, (double[]){0 - link->centre[0], 0 - link->centre[1], 0 - link->centre[2]}));
}

/* the frame of a joint in its parent link: that link's where the two are the same */
static const char *write_tail(Urdf *u, const Joint *joint, const char *own)
{
    const char *parent = u->links.at[joint->parent].frame;
    const ImportUrdfPose *origin = &joint->origin;

    if (own == NULL && is_zero(origin->at) && is_zero(origin->rpy))
        return parent;
    if (own == NULL)
        own = own_name(u, joint->name, "at");
    import_add(u->import, joint->element->line, "arm %s %s%s%s%s", own, parent,
               is_zero(origin->at) ? "" : " ", is_zero(origin->at) ? "" : vector(u, origin->at),
               rotation(u, origin->rpy));
    return own;
}

/* " axis=z", with the word for it */
static const char *axis_of(Urdf *u, const Joint *joint, const char *key)
{
    static const char *const words[] = {"x", "y", "z", "-x", "-y", "-z"};

    for (int i = 0; i < 6; i++) {
        double unit[3] = {0};

        unit[i % 3] = i < 3 ? 1 : -1;
        if (joint->axis[0] == unit[0] && joint->axis[1] == unit[1] && joint->axis[2] == unit[2])
            return import_text(u->import, "%s=%s", key, words[i]);
    }
    return import_text(u->import, "%s=%s", key, vector(u, joint->axis));
}

static void write_friction(Urdf *u, const Joint *joint, int line, double friction, double damping)
{
    const char *key = joint->kind == REVOLUTE ? "torque" : "force";
    const char *name = own_name(u, joint->name, "friction");
    const char *bound = import_number(u->import, friction);

    if (damping == 0)
        import_add(u->import, line, "friction %s %s %s=%s", name, joint->name, key, bound);
    else
        import_add(u->import, line, "friction %s %s %s=%s viscous=%s", name, joint->name, key,
                   bound, import_number(u->import, damping));
}

/* A range of the coordinate is a rigid stop. What else is limited stands in a comment. */
static Status write_limits(Urdf *u, const Joint *joint, const Element *limit)
{
    const char *type = xml_attribute(joint->element, "type");
    const bool is_endless = type != NULL && strcmp(type, "continuous") == 0;
    const bool may_stop = !is_endless && (joint->kind == REVOLUTE || joint->kind == PRISMATIC);
    double low = 0, high = 0;
    Text text = {0};
    bool stops;

    TRY(read_numbers(u, limit, "lower", 1, &low));
    TRY(read_numbers(u, limit, "upper", 1, &high));
    stops = may_stop && low < high;
    for (const Attribute *a = limit->attributes; a->name != NULL; a++)
        if (!stops || (strcmp(a->name, "lower") != 0 && strcmp(a->name, "upper") != 0))
            text_addf(&text, " %s=%s", a->name, a->value);
    if (text.length > 0) {
        import_comment(u->import, limit->line, "limits of %s:%s", joint->name, text.at);
        u->limits++;
    }
    if (stops)
        import_add(u->import, limit->line, "stop %s %s low=%s high=%s",
                   own_name(u, joint->name, "stop"), joint->name, import_number(u->import, low),
                   import_number(u->import, high));
    text_free(&text);
    return OK;
}

/* properties of a joint other than its freedom */
static Status write_extras(Urdf *u, const Joint *joint)
{
    const Element *limit = xml_child(joint->element, "limit");
    const Element *dynamics = xml_child(joint->element, "dynamics");
    double damping = 0, friction = 0;

    TRY(read_numbers(u, dynamics, "damping", 1, &damping));
    TRY(read_numbers(u, dynamics, "friction", 1, &friction));
    if (limit != NULL && joint->kind != FIXED)
        TRY(write_limits(u, joint, limit));
    if (friction != 0 && (joint->kind == REVOLUTE || joint->kind == PRISMATIC))
        write_friction(u, joint, dynamics->line, friction, damping);
    else if (damping != 0 && (joint->kind == REVOLUTE || joint->kind == PRISMATIC))
        import_add(u->import, dynamics->line, "damper %s %s d=%s",
                   own_name(u, joint->name, "damper"), joint->name,
                   import_number(u->import, damping));
    return OK;
}

static Status write_joint(Urdf *u, Joint *joint)
{
    static const char *const verbs[] = {"revolute", "prismatic", "weld", "free", "planarjoint"};
    ImportUrdfLink *child = &u->links.at[joint->child];
    const char *tail;

    joint->is_said = true;
    if (joint->kind == FIXED && child->mass == 0 && !has_inertia(child)) {
        child->frame = write_tail(u, joint, child->name);
        return OK;
    }
    write_body(u, child);
    tail = write_tail(u, joint, NULL);
    import_add(u->import, joint->element->line, "%s %s %s %s%s", verbs[joint->kind], joint->name,
               tail, child->frame,
               joint->kind == PLANAR                                 ? axis_of(u, joint, " normal")
               : joint->kind == REVOLUTE || joint->kind == PRISMATIC ? axis_of(u, joint, " axis")
                                                                     : "");
    return write_extras(u, joint);
}

static void write_root(Urdf *u, ImportUrdfLink *link)
{
    if (link->mass == 0 && !has_inertia(link)) {
        import_add(u->import, link->element->line, "arm %s ground", link->name);
        link->frame = link->name;
        return;
    }
    write_body(u, link);

    const char *hold = own_name(u, link->name, "hold");

    import_add(u->import, link->element->line, "weld %s ground %s", hold, link->frame);
    import_remark(u->import, link->element->line,
                  "%s is held on ground; 'free %s ground %s' in the place of the weld lets it go",
                  link->name, hold, link->frame);
}

/* from the roots on, each link before what hangs on it */
static Status write_trees(Urdf *u)
{
    LIST(int) waiting = {0};
    Status status = OK;

    for (int i = u->links.count - 1; i >= 0; i--)
        if (u->links.at[i].joint < 0)
            LIST_PUSH(waiting, i);
    while (waiting.count > 0) {
        ImportUrdfLink *link = &u->links.at[waiting.at[--waiting.count]];

        if (link->joint < 0)
            write_root(u, link);
        else
            CHECK(write_joint(u, &u->joints.at[link->joint]));
        for (int j = link->first_child; j >= 0; j = u->joints.at[j].next)
            LIST_PUSH(waiting, u->joints.at[j].child);
    }
    for (int j = 0; j < u->joints.count; j++)
        if (!u->joints.at[j].is_said)
            CHECK(import_refuse(u->import, u->joints.at[j].element->line, u->diag,
                                "joint '%.60s' closes a circle of links",
                                xml_attribute(u->joints.at[j].element, "name")));
done:
    LIST_FREE(waiting);
    return status;
}

/* --- mimic --- */

/* A joint that follows another, q = m*other + c. */
static Status write_mimic(Urdf *u, const Joint *joint)
{
    const Element *mimic = xml_child(joint->element, "mimic");
    const char *of = mimic != NULL ? xml_attribute(mimic, "joint") : NULL;
    const int number = of != NULL ? names_find(u->joint_names, of) : -1;
    const Joint *other = number >= 0 ? &u->joints.at[number] : NULL;
    double values[] = {1, 0};
    Import *import = u->import;
    const char *offset = "";

    if (mimic == NULL)
        return OK;
    TRY(read_numbers(u, mimic, "multiplier", 1, &values[0]));
    TRY(read_numbers(u, mimic, "offset", 1, &values[1]));
    if (other == NULL || other == joint || joint->kind > PRISMATIC || other->kind > PRISMATIC) {
        import_leave(import, mimic->line, true, import_text(import, "mimic of %s", joint->name),
                     "'%s' is no other joint of one coordinate", of != NULL ? of : "");
        return OK;
    }
    if (values[1] != 0)
        offset = import_text(import, " %c %s", values[1] < 0 ? '-' : '+',
                             import_number(import, fabs(values[1])));
    import_add(import, mimic->line, "coupler %s %s = %s*%s%s", own_name(u, joint->name, "mimic"),
               joint->name, import_number(import, values[0]), other->name, offset);
    return OK;
}

/* --- what is left out, by kind --- */

static void count_other(Urdf *u, const Element *element)
{
    const int kind = names_add(u->others, element->name);

    if (kind == u->counts.count) {
        LIST_PUSH(u->counts, 0);
        LIST_PUSH(u->lines, element->line);
    }
    assert(u->counts.at != NULL);
    u->counts.at[kind]++;
}

static void write_others(Urdf *u)
{
    for (int i = 0; i < u->counts.count; i++)
        import_leave(
            u->import, u->lines.at[i], false,
            import_text(u->import, "'%s' (%d of them)", names_get(u->others, i), u->counts.at[i]),
            "it is no part of the motion");
    if (u->limits > 0)
        import_remark(u->import, 0, "nothing holds to the limits of joints that stand in comments");
    import_remark(u->import, 0, "URDF has no gravity: gravity [0, 0, -9.81] adds it");
}

static bool is_one_of(const char *name, const char *const *words)
{
    for (; *words != NULL; words++)
        if (strcmp(*words, name) == 0)
            return true;
    return false;
}

static bool is_xacro(const Element *element)
{
    if (strncmp(element->name, "xacro:", 6) == 0)
        return true;
    for (const Attribute *a = element->attributes; a->name != NULL; a++)
        if (strstr(a->value, "${") != NULL || strstr(a->value, "$(") != NULL)
            return true;
    return false;
}

/* a text that a preprocessor has to convert first (xacro) isn't read */
static Status refuse_xacro(Urdf *u, const Element *root)
{
    for (const Element *e = root; e != NULL;) {
        if (is_xacro(e))
            return import_refuse(u->import, e->line, u->diag,
                                 "this is for xacro, which makes the robot of it first");
        if (e->first != NULL) {
            e = e->first;
            continue;
        }
        while (e != NULL && e->next == NULL)
            e = e->parent;
        e = e != NULL ? e->next : NULL;
    }
    return OK;
}

static Status read_robot(Urdf *u, const Element *root)
{
    static const char *const links[] = {"inertial", NULL};
    static const char *const joints[] = {"origin", "parent", "child",    "axis",
                                         "limit",  "mimic",  "dynamics", NULL};

    if (strcmp(root->name, "robot") != 0)
        return import_refuse(u->import, root->line, u->diag, "'%.60s' is no robot", root->name);
    TRY(refuse_xacro(u, root));
    for (const Element *e = root->first; e != NULL; e = e->next) {
        const bool is_link = strcmp(e->name, "link") == 0, is_joint = strcmp(e->name, "joint") == 0;

        if (is_link)
            TRY(read_link(u, e));
        if (!is_link && !is_joint)
            count_other(u, e);
        for (const Element *part = e->first; part != NULL && (is_link || is_joint);
             part = part->next)
            if (!is_one_of(part->name, is_link ? links : joints))
                count_other(u, part);
    }
    for (const Element *e = root->first; e != NULL; e = e->next)
        if (strcmp(e->name, "joint") == 0)
            TRY(read_joint(u, e));
    if (u->links.count == 0)
        return import_refuse(u->import, root->line, u->diag, "a robot without links");
    return OK;
}

Status importer_urdf(Import *import, const char *text, size_t length, Diag *diag)
{
    Urdf u = {.import = import, .diag = diag};
    Element *root = NULL;
    Status status;

    u.link_names = names_new();
    u.joint_names = names_new();
    u.others = names_new();
    CHECK(xml_read(import, text, length, &root, diag));
    CHECK(read_robot(&u, root));
    import_title(import, root->line, xml_attribute(root, "name"));
    CHECK(write_trees(&u));
    for (int i = 0; i < u.joints.count; i++)
        CHECK(write_mimic(&u, &u.joints.at[i]));
    write_others(&u);
done:
    LIST_FREE(u.links);
    LIST_FREE(u.joints);
    LIST_FREE(u.counts);
    LIST_FREE(u.lines);
    names_free(u.link_names);
    names_free(u.joint_names);
    names_free(u.others);
    return status;
}
