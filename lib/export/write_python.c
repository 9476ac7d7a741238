/* write_python.c: a model in Python with NumPy, of one instance or many at a time
 *
 * y and s are arrays of (numbers) or (numbers, instances); matrices have their rows and columns
 * first. */
#include "export/code.h"

#include <string.h>

static void open_function(Text *out, const Code *code, const CodeFunction *f, const char *locals)
{
    (void)code;
    (void)locals;
    text_addf(out, "\n\ndef %s(p, t, y, s):\n    \"\"\"%s\"\"\"\n    out = np.zeros((%d, ", f->name,
              f->what, f->rows);
    if (f->is_matrix)
        text_addf(out, "%d, ", f->columns);
    text_add(out, ") + shape_of(t, y))\n");
}

static const char head[] =
    "# \n$HEAD\nimport sys\n\nimport numpy as np\n\n"
    "P, Q, U, X, A, Y, Z, M, S = $NP, $Q, $U, $X, $A, $Y, $Z, $M, $S\nREDUNDANT = $REDUNDANT\n"
    "MODES = $MODES  # of ideal parts\nQUATERNIONS = [$FIRSTS]\n"
    "\n# array, place, name\nNAMES = [$NAMES\n]\n";

static const char tables[] =
    "\n\nTABLES = [$TABLES"
    "\n]  # x, y and y'' at the points of splines\n"
    "\n\ndef model_table(number, v, order):\n    x, y, m = TABLES[number - 1]\n"
    "    v = np.asarray(v, float)\n"
    "    i = np.clip(np.searchsorted(x, v, 'right') - 1, 0, len(x) - 2)\n"
    "    h = x[i + 1] - x[i]\n    a, b = (x[i + 1] - v)/h, (v - x[i])/h\n"
    "    inside = [\n"
    "        a*y[i] + b*y[i + 1] + ((a*a*a - a)*m[i] + (b*b*b - b)*m[i + 1])*h*h/6,\n"
    "        (y[i + 1] - y[i])/h + ((3*b*b - 1)*m[i + 1] - (3*a*a - 1)*m[i])*h/6,\n"
    "        a*m[i] + b*m[i + 1],\n        (m[i + 1] - m[i])/h,\n        0*v][min(order, 4)]\n"
    "    end = np.where(v < x[0], y[0], y[-1]) if order == 0 else 0\n"
    "    return np.where((v < x[0]) | (v > x[-1]), end, inside)\n";

static const char numbers[] =
    "\n\ndef prepare(p):\n"
    "    \"\"\"what follows from parameters alone: after one has changed\"\"\"\n$PREPARE"
    "    return p\n\n\ndef parameters():\n    p = np.zeros(P)\n$VALUES"
    "    return prepare(p)\n\n\ndef start():\n    \"\"\"y and s\"\"\"\n"
    "    y, s = np.zeros(Y), np.zeros(S)\n$START    return y, s\n";

static const char runtime[] =
    "$CODE\n\nmap_ = map\n"
    "\n\ndef shape_of(t, y):\n"
    "    return np.broadcast_shapes(np.shape(t), np.shape(y)[1:])\n"
    "\n\ndef linear(a):\n"
    "    \"\"\"x of A x = b, from the rows [A | b] of every instance\"\"\"\n"
    "    a = np.moveaxis(a, (0, 1), (-2, -1))\n    n = a.shape[-2]\n"
    "    size = np.abs(a[..., :n]).max(axis=-1, keepdims=True)\n"
    "    a = a/np.where(size > 0, size, 1)\n"
    "    size = np.abs(a[..., :n]).max(axis=-2)\n    size = np.where(size > 0, size, 1)\n"
    "    left, right = a[..., :n]/size[..., None, :], a[..., n:]\n"
    "    if REDUNDANT:  # the least of all solutions, of the unknowns as they are\n"
    "        x = (np.linalg.pinv(a[..., :n], 1e-10) @ right)[..., 0]\n"
    "        return np.moveaxis(x, -1, 0)\n"
    "    if MODES and np.any(np.linalg.cond(left) > 1e13):\n"
    "        raise ArithmeticError('the equations are singular in this mode')\n"
    "    x = np.linalg.solve(left, right)[..., 0]/size\n"
    "    return np.moveaxis(x, -1, 0)\n"
    "\n\ndef newton(rows, p, t, y, s, first, n):\n"
    "    \"\"\"s with the unknowns from first on such that residuals vanish.\n\n"
    "    Where the full step is next to nothing and does not halve the residual,\n"
    "    rounding hides what is left: s is the solution.\"\"\"\n    near = 0\n    s = np.array(s, "
    "float)\n"
    "    for _ in range(200):\n        a = rows(p, t, y, s)\n"
    "        weight = np.abs(a[:, :n]).max(axis=1)\n"
    "        lack = (np.abs(a[:, n])/weight).sum(axis=0)\n        x = linear(a)\n"
    "        old = s[first:first + n].copy()\n        step = np.ones_like(lack)\n        rest = "
    "np.zeros_like(lack)\n"
    "        for _ in range(60):\n            s[first:first + n] = old + step*x\n"
    "            if near:\n                break\n"
    "            with np.errstate(over='ignore', invalid='ignore'):\n"
    "                rest = (np.abs(rows(p, t, y, s)[:, n])/weight).sum(axis=0)\n"
    "            worse = ~(rest < lack) & (lack > 0)\n"
    "            if not np.any(worse):\n                break\n"
    "            step = np.where(worse, step/2, step)\n"
    "        change = np.abs(x).max(axis=0)\n        size = np.abs(old).max(axis=0)\n"
    "        stuck = (rest > lack/2) & (change <= 1e-12)\n"
    "        if np.any(stuck) and np.all(stuck | ~(lack > 0) | (change <= 1e-9*size)):\n"
    "            return s\n"
    "        near += np.all((change <= 1e-9*size) | ~(lack > 0))\n"
    "        if near > 2:\n            return s\n"
    "    raise ArithmeticError('no solution of the equations was found')\n";

static const char after[] =
    "\n\ndef solve(p, t, y, s):\n"
    "    \"\"\"s at a state; the s that is given is where Newton's method begins\"\"\"\n"
    "    s = np.zeros((S,) + shape_of(t, y)) + s\n$SOLVE    return s\n"
    "\n\ndef rates(p, t, y, s):\n    \"\"\"y', and s\"\"\"\n    s = solve(p, t, y, s)\n"
    "    return derivative(p, t, y, s), s\n"
    "\n\ndef nearest(p, t, y, b):\n"
    "    phi_u = jacobian(p, t, y, None)\n    n = U + M\n"
    "    a = np.zeros((n, n + 1) + phi_u.shape[2:])\n    a[range(U), range(U)] = 1\n"
    "    a[U:, :U] = phi_u\n    a[:U, U:n] = np.swapaxes(phi_u, 0, 1)\n    a[U:, n] = b\n"
    "    return linear(a)[:U]\n"
    "\n\ndef normalise(y):\n    for first in QUATERNIONS:\n"
    "        y[first:first + 4] /= np.sqrt((y[first:first + 4]**2).sum(axis=0))\n"
    "    return y\n"
    "\n\ndef project(p, t, y):\n    \"\"\"y on the constraints: positions, then speeds\"\"\"\n"
    "    y = normalise(np.array(y, float))\n    if M > 0:\n        for _ in range(20):\n"
    "            phi = constraints(p, t, y, None)[:, ...]\n"
    "            if np.abs(phi).max() <= 1e-13:\n                break\n"
    "            du = nearest(p, t, y, -phi)\n"
    "            y[:Q] += np.einsum('ij...,j...->i...', map_(p, t, y, None), du)\n"
    "            y = normalise(y)\n"
    "        lack = velocity(p, t, y, None) - np.einsum('ij...,j...->i...',\n"
    "            jacobian(p, t, y, None), y[Q:Q + U])\n"
    "        y[Q:Q + U] += nearest(p, t, y, lack)\n"
    "    if A > 0:\n        y[Q + U + X:] = angles(p, t, y, None)\n    return y\n"
    "\n\ndef $SMOOTH(p, t, h, y, s):\n"
    "    \"\"\"y and s one step of the classical Runge-Kutta method on, with projection\"\"\"\n"
    "    k1, s = rates(p, t, y, s)\n    k2, s = rates(p, t + h/2, y + h/2*k1, s)\n"
    "    k3, s = rates(p, t + h/2, y + h/2*k2, s)\n    k4, s = rates(p, t + h, y + h*k3, s)\n"
    "    return project(p, t + h, y + h/6*(k1 + 2*k2 + 2*k3 + k4)), s\n";

/* in the mode of ideal parts that p has, which code in this language doesn't leave by itself */
static const char step_in_mode[] =
    "\n\nCLOSED = $CLOSED  # where p has the sides of\nIDEAL = [$IDEALNAMES]\n"
    "\n\ndef hold_sides(p, t, y, s):\n"
    "    \"\"\"fails where an ideal part is on the other side than p has it\"\"\"\n"
    "    look, edge = looks(p, t, y, s), edges(p, t, y, s)\n"
    "    through, across = 1e-9*np.abs(edge).max(axis=0)\n"
    "    for k, name in enumerate(IDEAL):\n"
    "        closed = np.asarray(p[CLOSED + k]) > 0.5\n"
    "        condition = look[k, 2]\n"
    "        wrong = np.where(condition >= 0, (condition > 0.5) != closed,\n"
    "                         np.where(closed, look[k, 0] < -through, look[k, 1] > across))\n"
    "        if np.any(wrong):\n"
    "            raise ArithmeticError(\n"
    "                '%s goes over before t = %s: p has the mode, which export c changes by "
    "itself'\n"
    "                % (name, t))\n"
    "\n\ndef $STEP(p, t, h, y, s):\n"
    "    \"\"\"smooth_step(); fails where an ideal part goes over on the way\"\"\"\n"
    "    y, s = smooth_step(p, t, h, y, s)\n"
    "    s = solve(p, t + h, y, s)\n"
    "    hold_sides(p, t + h, y, s)\n"
    "    return y, s\n";

/* steps over sampling instants, whole multiples of the periods */
static const char sampled_step[] =
    "\n\nSAMPLED = np.array([$SAMPLED])  # in y\n"
    "\n\ndef sample(p, t, y, s):\n"
    "    \"\"\"y with the sampled states that are due at t\"\"\"\n"
    "    period = periods(p, t, y, s)\n    count = t/period\n"
    "    due = np.abs(count - np.round(count)) <= 1e-9\n    if not np.any(due):\n"
    "        return y, s\n    s = solve(p, t, y, s)\n    y = y.copy()\n"
    "    y[SAMPLED] = np.where(due, samples(p, t, y, s), y[SAMPLED])\n    return y, s\n"
    "\n\ndef step(p, t, h, y, s):\n"
    "    \"\"\"step_between() over sampling instants; one at its end is the next step's\"\"\"\n"
    "    end = t + h\n    period = periods(p, t, y, s)\n    while t < end:\n"
    "        instants = period*(np.floor(t/period + 1e-9) + 1)\n"
    "        until = np.min(np.where(instants < end - 1e-9*period, instants, end))\n"
    "        y, s = sample(p, t, y, s)\n        y, s = step_between(p, t, until - t, y, s)\n"
    "        t = until\n    return y, s\n";

static const char states[] =
    "\n\nSIZES = $SIZES\nFUNCTIONS = [$CALLS]\n# t, y, s, and sums over what each function gives\n"
    "STATES = [$CASES\n]\n";

/* The same functions with SymPy in place of np: then they compute with symbols. */
static const char symbols[] =
    "\n\ndef symbolic():\n"
    "    \"\"\"The functions as matrices of SymPy, by name, and the symbols p, t, y, s that they "
    "are\n"
    "    over, called as in the model. What asks on which side of something it is has none.\"\"\"\n"
    "    global np\n    import sympy\n\n    numpy = np\n\n"
    "    class Stand:\n        pi = sympy.pi\n"
    "        sin, cos, tan = sympy.sin, sympy.cos, sympy.tan\n"
    "        arcsin, arccos, arctan = sympy.asin, sympy.acos, sympy.atan\n"
    "        sinh, cosh, tanh, arctan2 = sympy.sinh, sympy.cosh, sympy.tanh, sympy.atan2\n"
    "        exp, log, sqrt, abs, sign = sympy.exp, sympy.log, sympy.sqrt, sympy.Abs, sympy.sign\n"
    "        minimum, maximum = sympy.Min, sympy.Max\n"
    "        floor, ceil = sympy.floor, sympy.ceiling\n"
    "        shape, broadcast_shapes = numpy.shape, numpy.broadcast_shapes\n\n"
    "        @staticmethod\n        def zeros(shape):\n"
    "            return numpy.zeros(shape, object)\n\n"
    "    t = sympy.Symbol('t', real=True)\n    p, y, s = (numpy.zeros(n, object) for n in (P, Y, "
    "S))\n"
    "    for array, place, name in NAMES:\n"
    "        {'p': p, 'y': y, 's': s}[array][place] = sympy.Symbol(name, real=True)\n"
    "    over = [[x for x in array if x != 0] for array in (p, [t], y, s)]\n    found = {}\n"
    "    np = Stand\n    try:\n        p = prepare(p)\n        for function in FUNCTIONS:\n"
    "            try:\n                found[function.__name__] = sympy.Matrix(function(p, t, y, "
    "s))\n"
    "            except (AttributeError, TypeError):\n                pass\n"
    "    finally:\n        np = numpy\n    return found, over\n"
    "\n\ndef check_symbolic():\n    import sympy\n\n    found, over = symbolic()\n"
    "    p, worst, bad = parameters(), 0, 0\n"
    "    given = [p[place] for array, place, name in sorted(NAMES) if array == 'p']\n"
    "    for t, y, s, sums in STATES[:3]:\n"
    "        y = np.array(y)*(1 + (np.arange(Y) % 5 + 1)/32)\n"
    "        for k, function in enumerate(FUNCTIONS):\n"
    "            matrix = found.get(function.__name__)\n"
    "            if matrix is None or not len(matrix):\n                continue\n"
    "            numbers = given + [t, *y, *s]\n"
    "            compute = sympy.lambdify(sum(over, []), matrix, 'numpy', cse=True)\n"
    "            out = np.asarray(compute(*numbers), float).reshape(-1)\n"
    "            total = ((1 + np.arange(len(out)) % 7)*out).sum()\n"
    "            off = abs(total - sums[k][0])/(sums[k][1] or 1)\n"
    "            worst, bad = max(worst, off), bad + (not off <= 1e-12)\n"
    "    print('%d of %d functions in symbols: %s, off by %.1e at most' % (\n"
    "        len(found), len(FUNCTIONS), 'NOT as they were' if bad else 'all as they were', "
    "worst))\n"
    "    return bad\n";

static const char check[] =
    "\n\ndef check():\n    p = parameters()\n    worst, bad = 0, 0\n"
    "    times = np.array([state[0] for state in STATES])\n"
    "    ys = np.array([state[1] for state in STATES], float).T\n"
    "    rights = np.array([state[2] for state in STATES], float).T\n"
    "    parts = np.repeat(SIZES, (X, Z, U, M))\n"
    "    found = solve(p, times, ys, rights*(1 + 1e-3))  # all states at a time\n"
    "    one = solve(p, times[0], ys[:, 0], rights[:, 0]*(1 + 1e-3))\n"
    "    offs = [np.abs(found - rights)/np.where(parts > 0, parts, 1)[:, None],\n"
    "            (np.abs(one - rights[:, 0])/np.where(parts > 0, parts, 1))[:, None]]\n"
    "    factor = 1 + (np.arange(Y) % 5 + 1)/32  # away from the constraints\n"
    "    ys = ys*factor[:, None]\n"
    "    for k, function in enumerate(FUNCTIONS):\n"
    "        out = function(p, times, ys, rights)\n"
    "        out = out.reshape((-1, len(STATES)))\n"
    "        total = ((1 + np.arange(len(out)) % 7)[:, None]*out).sum(axis=0)\n"
    "        should = np.array([state[3][k] for state in STATES])\n"
    "        offs.append(np.abs(total - should[:, 0])/np.where(should[:, 1] > 0, should[:, 1], "
    "1))\n"
    "    for off in offs:\n        if off.size:\n            worst = max(worst, off.max())\n"
    "            bad += not off.max() <= 1e-12\n"
    "    print('%d states: %s, off by %.1e at most' % (\n"
    "        len(STATES), 'NOT as they were' if bad else 'all as they were', worst))\n"
    "    return bad\n"
    "\n\nif __name__ == '__main__':\n"
    "    sys.exit((check_symbolic() if sys.argv[1:] == ['symbolic'] else check()) > 0)\n";

static void add_list(Text *out, const double *values, int count)
{
    text_char(out, '[');
    layout_numbers(out, values, count, ",\n        ");
    text_char(out, ']');
}

static void write_calls(const Code *code, const Language *language, Text *out)
{
    (void)language;
    for (int f = 0; f < code->functions.count; f++)
        text_addf(out, "%s%s%s",
                  f == 0       ? ""
                  : f % 6 == 0 ? ",\n    "
                               : ", ",
                  code->functions.at[f].name,
                  strcmp(code->functions.at[f].name, "map") == 0 ? "_" : "");
}

static void write_states(const Code *code, const Language *language, Text *out)
{
    (void)language;
    for (int k = 0; k < code->states.count; k++) {
        const CodeState *state = &code->states.at[k];

        text_add(out, "\n    (");
        text_number(out, state->t, 17);
        text_add(out, ",\n        ");
        add_list(out, state->y, code->ny);
        text_add(out, ",\n        ");
        add_list(out, state->s, code->ns);
        text_add(out, ",\n        [");
        for (int f = 0; f < code->functions.count; f++) {
            text_add(out, f > 0 ? ",\n        (" : "(");
            text_number(out, state->sums[f], 17);
            text_add(out, ", ");
            text_number(out, state->size[f], 17);
            text_char(out, ')');
        }
        text_add(out, "]),");
    }
}

static void write_names(const Code *code, const Language *language, Text *out)
{
    static const char letters[] = {[CODE_P] = 'p', [CODE_Y] = 'y', [CODE_S] = 's'};

    (void)language;
    for (int i = 0; i < code->inputs.count; i++) {
        const CodeInput *input = &code->inputs.at[i];
        const int of_layout = i - code->parameters.count;
        const Expr symbol =
            of_layout < 0 ? code->parameters.at[i] : code->layout->symbols[of_layout];

        if (input->array != CODE_T)
            text_addf(out, "\n    ('%c', %d, \"%s\"),", letters[input->array], input->place,
                      expr_name(symbol));
    }
}

static void write_tables(const Code *code, const Language *language, Text *out)
{
    (void)language;
    for (int i = 0; i < code->lowered.tables.count; i++) {
        const Curve *curve = code->lowered.tables.at[i];

        text_addf(out, "%s\n    np.reshape(", i > 0 ? "," : "");
        add_list(out, curve->data, 3 * curve->count);
        text_addf(out, ", (3, %d))", curve->count);
    }
}

static const CodeWord words[] = {{"NAMES", write_names},
                                 {"TABLES", write_tables},

                                 {"CALLS", write_calls},
                                 {"CASES", write_states},
                                 {NULL, NULL}};

static const CodeText texts[] = {{head, CODE_ALWAYS},
                                 {tables, CODE_WITH_TABLES},
                                 {numbers, CODE_ALWAYS},
                                 {runtime, CODE_ALWAYS},
                                 {after, CODE_ALWAYS},
                                 {step_in_mode, CODE_WITH_MODES},
                                 {sampled_step, CODE_WITH_SAMPLES},
                                 {states, CODE_ALWAYS},
                                 {symbols, CODE_ALWAYS},
                                 {check, CODE_ALWAYS},
                                 {NULL, CODE_ALWAYS}};

const Language language_python = {
    .notation = NOTATION_NUMPY,
    .array = "%s[%d]",
    .matrix = "%s[%d, %d]",
    .local = "%s = %s",
    .result = "%s = %s",
    .onward = "\\",
    .power = {"(", "**", ")"},
    .open = open_function,
    .close = "    return out\n",
    .check = "python3 FILE.py",
    .between = ", ",
    .truth = {"False", "True"},
    .ideal = {"'%s'", ",\n    "},
    .solve = {"    s = newton(%s, p, t, y, s, %d, %d)\n", "    s[%d:%d] = linear(%s(p, t, y, s))\n",
              "    s[%d:%d] = accelerations(p, t, y, s)\n"},
    .words = words,
    .texts = texts,
};
