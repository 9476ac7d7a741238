# what Tab would offer, for editors and tests
cat >model.ct <<'END'
scene planar; body mass1 mass=1 inertia=1
complete revo
complete show circ
complete body m2 inert
complete body m2 mass=1 
complete set p
complete set pager 
complete draw 
complete draw cutset ma
complete set digits 
complete print mass1.x [m
complete expect mass1.x ~ 2 
complete plot mass1.x v
complete set mass1.mass = 2 k
complete help ener
complete export csv st
complete export csv mass1.x st
complete export c inv
complete export cs
END
cotree model.ct
cotree -e complete | grep -x plot
echo 'complete info mas' >>model.ct
cotree model.ct | grep -x mass1
# a subsystem as a black box, and its halves
cat >box.ct <<'END'
subsystem low terminals=[a] through=[b]
  resistor R a b 1 kohm
end
complete show lo
complete show low 
complete show low p
END
cotree box.ct
