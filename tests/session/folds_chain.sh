# entries of M of a chain of 100 bodies, whose equations are too long to be written out
awk 'BEGIN {
    print "scene planar; L = 0.3 m"
    for (i = 1; i <= 100; i++) {
        printf "body b%d mass=1 inertia=0.01; arm c%d b%d [-L/2, 0]; arm d%d b%d [L/2, 0]\n", i, i, i, i, i
        printf "revolute h%d %s c%d\n", i, i == 1 ? "ground" : "d" (i - 1), i
    }
    print "show mass 100 100; show mass(100,100); show mass 98 98; show mass 97 100"
}' | cotree -q -
