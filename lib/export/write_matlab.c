/* write_matlab.c: a model as a function file of Matlab and Octave, model('mass', p, t, y, s) */
#include "export/code.h"

static void open_function(Text *out, const Code *code, const CodeFunction *f, const char *locals)
{
    (void)code;
    (void)locals;
    text_addf(out, "\n%% %s\nfunction out = model_%s(p, t, y, s)\n    out = zeros(%d, %d);\n",
              f->what, f->name, f->rows, f->columns);
}

static const char head[] =
    "$HEAD"
    "function varargout = model(name, varargin)\n"
    "    [varargout{1:nargout}] = feval(['model_' name], varargin{:});\nend\n"
    "\n% how many numbers there are in p, q, u, x, references, y, z, lambda, s\n"
    "function out = model_sizes()\n"
    "    out = struct('P', $NP, 'Q', $Q, 'U', $U, 'X', $X, 'A', $A, 'Y', $Y, ...\n"
    "        'Z', $Z, 'M', $M, 'S', $S, 'quaternions', [$FIRSTS]);\nend\n"
    "\n% what follows from parameters alone: after one has changed\n"
    "function p = model_prepare(p)\n$PREPARE"
    "end\n\n% their values\nfunction p = model_parameters()\n    p = zeros($NP, 1);\n$VALUES"
    "    p = model_prepare(p);\nend\n\n% initial conditions, and s there\n"
    "function [y, s] = model_start()\n    y = zeros($Y, 1);\n    s = zeros($S, 1);\n$START"
    "end\n";

static const char tables[] =
    "\n% a spline through data, or a derivative of it\n"
    "function out = model_table(number, v, order)\n    switch number\n$TABLES"
    "    end\n    n = numel(d)/3;\n    x = d(1:n);\n    f = d(n + 1:2*n);\n"
    "    m = d(2*n + 1:end);\n    if v < x(1) || v > x(n)\n"
    "        ends = [f(1), f(n)];\n"
    "        out = (order == 0)*ends(1 + (v > x(n)));\n        return\n    end\n"
    "    k = min(max(sum(x <= v), 1), n - 1);\n    h = x(k + 1) - x(k);\n"
    "    a = (x(k + 1) - v)/h;\n    b = (v - x(k))/h;\n    switch order\n    case 0\n"
    "        out = a*f(k) + b*f(k + 1) + ((a^3 - a)*m(k) + (b^3 - b)*m(k + 1))*h*h/6;\n"
    "    case 1\n"
    "        out = (f(k + 1) - f(k))/h + ((3*b*b - 1)*m(k + 1) - (3*a*a - 1)*m(k))*h/6;"
    "\n    case 2\n        out = a*m(k) + b*m(k + 1);\n    case 3\n"
    "        out = (m(k + 1) - m(k))/h;\n    otherwise\n        out = 0;\n    end\n"
    "end\n";

static const char runtime[] =
    "$CODE\n% c where it isn't 0, else\nfunction out = model_if(c, yes, no)\n    if c ~= 0\n"
    "        out = yes;\n    else\n        out = no;\n    end\nend\n"
    "\n% A x = b from the rows [A | b]\nfunction x = model_linear(a)\n    n = rows_of(a);\n"
    "    d = max(abs(a(:, 1:n)), [], 2);\n    d(d == 0) = 1;\n    a = a./repmat(d, 1, n + 1);\n"
    "    if $REDUNDANT % the least of all solutions\n"
    "        x = pinv(a(:, 1:n), 1e-10)*a(:, n + 1);\n        return\n    end\n"
    "    d = max(abs(a(:, 1:n)), [], 1);\n    if any(d == 0)\n"
    "        error('the equations are singular');\n    end\n"
    "    left = a(:, 1:n)./repmat(d, n, 1);\n    [~, pivots, ~] = lu(left);\n"
    "    if any(abs(diag(pivots)) <= 1e-14)\n        error('the equations are singular');\n    "
    "end\n"
    "    x = left\\a(:, n + 1)./d';\nend\n"
    "\nfunction n = rows_of(a)\n    n = size(a, 1);\nend\n"
    "\n% Newton's method, its steps shortened where they lead away. Where the full step is next to "
    "nothing\n"
    "% and does not halve the residual, rounding hides what is left: s is the solution.\n"
    "function s = model_newton(name, p, t, y, s, first, n)\n    near = 0;\n"
    "    at = first:first + n - 1;\n    for tries = 1:200\n"
    "        a = feval(name, p, t, y, s);\n        weight = max(abs(a(:, 1:n)), [], 2);\n"
    "        lack = sum(abs(a(:, n + 1))./weight);\n        if ~isfinite(lack)\n"
    "            break\n        end\n        x = model_linear(a);\n"
    "        old = s(at);\n        part = 1;\n        rest = 0;\n        for halves = 1:60\n"
    "            s(at) = old + part*x;\n            if near > 0 || ~(lack > 0)\n"
    "                break\n            end\n            a = feval(name, p, t, y, s);\n"
    "            rest = sum(abs(a(:, n + 1))./weight);\n            if rest < lack\n"
    "                break\n            end\n"
    "            part = part/2;\n        end\n"
    "        if near == 0 && rest > lack/2 && max(abs(x)) <= 1e-12\n            return\n        "
    "end\n"
    "        near = near + (max(abs(x)) <= 1e-9*max(abs(old)) || ~(lack > 0));\n"
    "        if near > 2\n            return\n        end\n    end\n"
    "    error('no solution of the equations was found');\nend\n";

static const char after[] =
    "\n% s for a state; the s that is given is where Newton's method begins\n"
    "function s = model_solve(p, t, y, s)\n$SOLVE"
    "end\n"
    "\n% y', and s\nfunction [out, s] = model_rates(p, t, y, s)\n    s = model_solve(p, t, "
    "y, s);\n"
    "    out = model_derivative(p, t, y, s);\nend\n"
    "\nfunction du = model_nearest(p, t, y, b)\n    k = model_sizes();\n"
    "    phi_u = model_jacobian(p, t, y, []);\n"
    "    x = model_linear([eye(k.U), phi_u', zeros(k.U, 1); phi_u, zeros(k.M), b]);\n"
    "    du = x(1:k.U);\nend\n"
    "\nfunction y = model_normalise(y)\n    k = model_sizes();\n    for first = k.quaternions\n"
    "        y(first:first + 3) = y(first:first + 3)/norm(y(first:first + 3));\n    end\nend\n"
    "\n% y on the constraints: positions, then speeds\nfunction y = model_project(p, t, y)\n"
    "    k = model_sizes();\n    y = model_normalise(y);\n    if k.M > 0\n"
    "        for sweep = 1:20\n            phi = model_constraints(p, t, y, []);\n"
    "            if max(abs(phi)) <= 1e-13\n                break\n            end\n"
    "            y(1:k.Q) = y(1:k.Q) + model_map(p, t, y, [])*model_nearest(p, t, y, -phi);\n"
    "            y = model_normalise(y);\n        end\n"
    "        u = k.Q + 1:k.Q + k.U;\n"
    "        lack = model_velocity(p, t, y, []) - model_jacobian(p, t, y, [])*y(u);\n"
    "        y(u) = y(u) + model_nearest(p, t, y, lack);\n    end\n    if k.A > 0\n"
    "        y(k.Q + k.U + k.X + 1:end) = model_angles(p, t, y, []);\n    end\nend\n"
    "\n% one step of the classical Runge-Kutta method, with projection\n"
    "function [y, s] = model_$SMOOTH(p, t, h, y, s)\n    [k1, s] = model_rates(p, t, y, s);\n"
    "    [k2, s] = model_rates(p, t + h/2, y + h/2*k1, s);\n"
    "    [k3, s] = model_rates(p, t + h/2, y + h/2*k2, s);\n"
    "    [k4, s] = model_rates(p, t + h, y + h*k3, s);\n"
    "    y = model_project(p, t + h, y + h/6*(k1 + 2*k2 + 2*k3 + k4));\nend\n";

/* in the mode of ideal parts that p has, which code in this language doesn't leave by itself */
static const char step_in_mode[] =
    "\n% fails where an ideal part is on the other side than p has it\n"
    "function model_hold_sides(p, t, y, s)\n    first = $CLOSED;\n    names = {$IDEALNAMES};\n"
    "    look = model_looks(p, t, y, s);\n    most = 1e-9*max(abs(model_edges(p, t, y, s)), [], "
    "1);\n"
    "    for k = 1:numel(names)\n        closed = p(first + k - 1) > 0.5;\n"
    "        if look(k, 3) >= 0\n            wrong = (look(k, 3) > 0.5) ~= closed;\n"
    "        elseif closed\n            wrong = look(k, 1) < -most(1);\n"
    "        else\n            wrong = look(k, 2) > most(2);\n        end\n"
    "        if wrong\n"
    "            error('%s goes over before t = %g: p has the mode, which export c changes by "
    "itself', ...\n                names{k}, t);\n        end\n    end\nend\n"
    "\n% smooth_step; fails where an ideal part goes over on the way\n"
    "function [y, s] = model_$STEP(p, t, h, y, s)\n"
    "    [y, s] = model_smooth_step(p, t, h, y, s);\n"
    "    s = model_solve(p, t + h, y, s);\n    model_hold_sides(p, t + h, y, s);\nend\n";

/* steps over sampling instants, whole multiples of the periods */
static const char sampled_step[] =
    "\n% the sampled states that are due at t\n"
    "function [y, s] = model_sample(p, t, y, s)\n    sampled = [$SAMPLED];\n"
    "    period = model_periods(p, t, y, s);\n"
    "    due = abs(t./period - round(t./period)) <= 1e-9;\n    if any(due)\n"
    "        s = model_solve(p, t, y, s);\n        next = model_samples(p, t, y, s);\n"
    "        y(sampled(due)) = next(due);\n    end\nend\n"
    "\n% model_step_between over sampling instants; one at its end is the next step's\n"
    "function [y, s] = model_step(p, t, h, y, s)\n    stop = t + h;\n"
    "    period = model_periods(p, t, y, s);\n    while t < stop\n"
    "        instants = period.*(floor(t./period + 1e-9) + 1);\n"
    "        until = min([stop; instants(instants < stop - 1e-9*period)]);\n"
    "        [y, s] = model_sample(p, t, y, s);\n"
    "        [y, s] = model_step_between(p, t, until - t, y, s);\n        t = until;\n"
    "    end\nend\n";

static const char check[] =
    "\nfunction bad = model_check()\n    k = model_sizes();\n    p = model_parameters();\n"
    "    worst = 0;\n    bad = 0;\n    scales = [];\n    parts = [k.X, k.Z, k.U, k.M];\n"
    "    sizes = $SIZES;\n    for part = 1:4\n"
    "        scales = [scales; repmat(sizes(part) + (sizes(part) == 0), parts(part), 1)];\n"
    "    end\n    for number = 1:$STATES\n        [t, y, right, sums] = model_state(number);\n"
    "        s = model_solve(p, t, y, right*(1 + 1e-3));\n"
    "        offs = abs(s - right)./scales;\n"
    "        y = y.*(1 + (mod((0:k.Y - 1)', 5) + 1)/32); % away from the constraints\n"
    "        names = $NAMES;\n        for f = 1:numel(names)\n"
    "            out = feval(['model_' names{f}], p, t, y, right)';\n            out = out(:);\n"
    "            total = sum((1 + mod((0:numel(out) - 1)', 7)).*out);\n"
    "            offs(end + 1, 1) = abs(total - sums(f, 1))/(sums(f, 2) + (sums(f, 2) == 0));\n"
    "        end\n        worst = max([worst; offs]);\n        bad = bad + ~all(offs <= 1e-12);\n"
    "    end\n    said = {'all as they were', 'NOT as they were'};\n"
    "    fprintf('%d states: %s, off by %.1e at most\\n', $STATES, said{1 + (bad > 0)}, worst);\n"
    "end\n"
    "\nfunction [t, y, s, sums] = model_state(number)\n    t = 0;\n"
    "    y = zeros($Y, 1);\n    s = zeros($S, 1);\n    sums = zeros($FUNCTIONS, 2);\n"
    "    switch number\n$CASES    end\nend\n";

static void write_tables(const Code *code, const Language *language, Text *out)
{
    (void)language;
    for (int i = 0; i < code->lowered.tables.count; i++) {
        const Curve *curve = code->lowered.tables.at[i];

        text_addf(out, "    case %d\n        d = [", i + 1);
        layout_numbers(out, curve->data, 3 * curve->count, ", ...\n            ");
        text_add(out, "];\n");
    }
}

static void write_names(const Code *code, const Language *language, Text *out)
{
    (void)language;
    for (int f = 0; f < code->functions.count; f++)
        text_addf(out, "%s'%s'",
                  f == 0       ? "{"
                  : f % 5 == 0 ? ", ...\n            "
                               : ", ",
                  code->functions.at[f].name);
    text_char(out, '}');
}

static const CodeWord words[] = {{"TABLES", write_tables}, {"NAMES", write_names}, {NULL, NULL}};

static const CodeText texts[] = {{head, CODE_ALWAYS},
                                 {tables, CODE_WITH_TABLES},
                                 {runtime, CODE_ALWAYS},
                                 {after, CODE_ALWAYS},
                                 {step_in_mode, CODE_WITH_MODES},
                                 {sampled_step, CODE_WITH_SAMPLES},
                                 {check, CODE_ALWAYS},
                                 {NULL, CODE_ALWAYS}};

const Language language_matlab = {
    .notation = NOTATION_MATLAB,
    .array = "%s(%d)",
    .matrix = "%s(%d, %d)",
    .local = "%s = %s;",
    .result = "%s = %s;",
    .onward = "...",
    .power = {"(", "^", ")"},
    .open = open_function,
    .close = "end\n",
    .check = "octave --eval \"FILE('check')\"",
    .between = "; ",
    .truth = {"false", "true"},
    .ideal = {"'%s'", ", ...\n        "},
    .solve = {"    s = model_newton('model_%s', p, t, y, s, %d, %d);\n",
              "    s(%d:%d) = model_linear(model_%s(p, t, y, s));\n",
              "    s(%d:%d) = model_accelerations(p, t, y, s);\n"},
    .state = "    case %d\n",
    .sums = "sums(%d, :)",
    .words = words,
    .texts = texts,
};
