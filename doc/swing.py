# A pendulum in Python: run it, read the results, linearise it, and use its model as a function.
import cotree

session = cotree.Session()
session.run("""scene planar; gravity [0, -9.81]; L = 0.5 m
    body bob mass=1 inertia=0.01; arm top bob [0, L]; revolute h ground top
    init h = 30 deg
    simulate 1 every=0.01""")
names, rows = session.table("h h'")
print('%s is %.6f rad after a second, %d rows' % (names[1], session.value('h'), len(rows)))

# hold it upright by a torque that is set a hundred times a second
session.run('input U1 u 0 period=10 ms; actuator a1 h torque=U1.v; init h = 3')
session.simulate(3, "h h'", input=lambda name, t, at: 40 * (3.1416 - at[0]) - 8 * at[1], every=0.1)
values, units = session.columns('h')
print('%s is %.4f %s' % ('h', values['h'][-1], units['h']))
session.run('delete a1; delete U1; init h = 30 deg')

model = session.model(derivatives='derivative')
p, y, s = model.start()
y[0] = y[1] = 0  # hanging
compute = model.evaluator()
for length in 0.5, 1:
    p[model.parameters.index('L')] = length  # needs no compilation
    s = compute.solve(p, 0, y)
    slopes = compute.derivatives('derivative', cotree.STATE, p, 0, y, s)
    stiffness = -slopes[1][0]
    print('at %g m a period takes %.4f s' % (length, 2 * 3.141592653589793 / stiffness**0.5))
