# a part and a parameter of one name, in either order: bare it is the parameter, NAME.member and
# what names a part are of the part
cat > one_name.ct << 'END'
k6 = 10
scene planar
body m1 mass=2
arm p1 m1 [0, 0]
arm g ground [0, 0]
spring k6 g p1 k=k6
m1 = 2                       # after the part
set m1.mass = m1
prismatic s ground m1 axis=x
init s = 0.3
END
cat > ask.ct << 'END'
simulate 2 every=0.1
expect s ~ 0.3*cos(2*sqrt(10/2)) within 1e-6
expect abs(k6.effort) ~ 10*abs(s) within 1e-12
expect m1.x ~ s within 1e-12
expect m1 == 2
expect k6 == 10
set k6 = 40
simulate 1
expect s ~ 0.3*cos(sqrt(40/2)) within 1e-6
set k6.k = 3*k6, k6 = 5
simulate 1
expect s ~ 0.3*cos(sqrt(3*5/2)) within 1e-6
undo
simulate 1
expect s ~ 0.3*cos(sqrt(40/2)) within 1e-6
redo
simulate 1
expect s ~ 0.3*cos(sqrt(3*5/2)) within 1e-6
END
cotree one_name.ct ask.ct > /dev/null && echo "as typed"
cotree -e 'source "one_name.ct"' -e 'save "saved.ct"' && cotree -q saved.ct ask.ct > /dev/null &&
    echo "as saved"

echo "--- what names a part, and what names a value"
cotree -q one_name.ct - << 'END' 2>&1
show params
print k6, m1
info k6
show derivation k6
complete delete k
delete k6
print k6
delete k6
print k6
END

echo "--- in programs, a name that stands for itself has another on its left"
cotree -q one_name.ct - << 'END' 2>&1
show k6 as c
show k6.effort as fortran
show k6 m1.x s as python
value = 3
show k6 as matlab
END

echo "--- inside, names are its own, then the model's"
cotree -q - << 'END' 2>&1
C1 = 1 uF
V1 = 5 V
subsystem leg terminals=[a]
  R1 = 100 ohm
  resistor R1 a b R1
  capacitor C1 b 0 1 nF
  capacitor C2 b 0 C1 - 1 nF   # the model's
end
vsource V1 n 0 V1*sin(100*t)
use leg leg1 a=n R1=200
set leg1.R1 = 50
set leg1.R1.R = 2*leg1.R1
info leg1
show state
linearize inputs=[V1] outputs=[leg1.b.v]
show transfer
END

echo "--- not with what is a value itself"
cotree -q -k - << 'END' 2>&1
scene planar
h1 = 3
body b mass=1
revolute h1 ground b
revolute h2 ground b
h2 = 4
output b = 3
b(x) = 3
event b when=t > 1 do=stop
b = 2
resistor R1 b 0 1
delete b
END
rm -f one_name.ct ask.ct saved.ct
