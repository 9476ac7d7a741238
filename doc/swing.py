# A pendulum in Python: run, read, and linearised, with its model as a function of numbers.
import cotree

session = cotree.Session()
session.run("""scene planar; gravity [0, -9.81]; L = 0.5 m
    body bob mass=1 inertia=0.01; arm top bob [0, L]; revolute h ground top
    init h = 30 deg
    simulate 1 every=0.01""")
names, rows = session.table("h h'")
print('%s is %.6f rad after a second, %d rows' % (names[1], session.value('h'), len(rows)))

model = session.model(derivatives='derivative')
p, y, s = model.start()
y[0] = y[1] = 0  # hanging
compute = model.evaluator()
for length in 0.5, 1:
    p[model.parameters.index('L')] = length  # nothing is compiled anew
    s = compute.solve(p, 0, y)
    slopes = compute.derivatives('derivative', cotree.STATE, p, 0, y, s)
    stiffness = -slopes[1][0]
    print('at %g m a period takes %.4f s' % (length, 2 * 3.141592653589793 / stiffness**0.5))
