# a robot becomes statements; what is left out is said, and what is no robot refused at its line
try() { # body of <robot>
    printf '<robot name="r">\n%s\n</robot>\n' "$1" >try.urdf
    echo "--- $2"
    cotree -q -e 'import urdf "try.urdf"' -e 'print model.n, model.dof' 2>&1 |
        sed '/import urdf/,$d; s/^-e:[0-9]*:[0-9]*: //'
}
mass='<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
cat >arm.urdf <<END
<robot name="an &quot;arm&quot;">
  <link name="base-link">$mass<visual/></link>
  <link name="upper arm"><inertial><origin xyz="0 0 0.5" rpy="1.5707963267949 0 0"/><mass value="2"/>
    <inertia ixx="1" iyy="2" izz="2.5" ixy="0" ixz="0" iyz="0"/></inertial><visual/></link>
  <link name="1"/>
  <link name="finger">$mass</link>
  <link name="thumb">$mass</link>
  <joint name="upper arm" type="revolute"><parent link="base-link"/><child link="upper arm"/>
    <origin xyz="0 0 0.1" rpy="0 -1.5707963268 0.5"/><axis xyz="0 -1 0"/>
    <limit lower="-1" upper="1" effort="5" velocity="1"/><dynamics damping="0.1"/></joint>
  <joint name="tool" type="fixed"><parent link="upper arm"/><child link="1"/><origin xyz="0 0 1"/></joint>
  <joint name="slide" type="prismatic"><parent link="1"/><child link="finger"/><axis xyz="1 0 0"/>
    <dynamics damping="2" friction="0.3"/></joint>
  <joint name="turn" type="revolute"><parent link="1"/><child link="thumb"/>
    <mimic joint="slide" multiplier="2" offset="-0.1"/></joint>
  <transmission name="t"/>
</robot>
END
cotree -e 'import urdf "arm.urdf" > "arm.ct"' -e 'source "arm.ct"' -e 'check' 2>&1
cat arm.ct
echo '--- a limit holds'
cotree -q -e 'import urdf "arm.urdf"' -e "init upper_arm_2 = 0, upper_arm_2' = 30" -e 'simulate 0.2' \
    -e 'expect max(upper_arm_2) < 1 + 1e-9; expect max(upper_arm_2) > 1 - 1e-3' \
    -e 'expect min(upper_arm_2) > -1 - 1e-9' 2>&1
echo '--- the follower follows'
cotree -q -e 'import urdf "arm.urdf"' \
    -e 'driver D1 slide = 0.2*sin(2*t); driver D2 upper_arm_2 = 0' -e 'simulate 3' \
    -e 'expect max(abs(turn - 2*slide + 0.1)) < 1e-9' 2>&1
try '<link name="a"/>' 'a frame alone'
try '<link name="a"/><link name="a"/>' 'twice'
try '<link name="a"/><joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>' 'no such link'
try '<link name="a"/><link name="b"/>
<joint name="j" type="hinge"><parent link="a"/><child link="b"/></joint>' 'no such joint'
try '<link name="a"/><link name="b"/><joint name="j" type="revolute">
<parent link="a"/><child link="b"/><axis xyz="0 0 0"/></joint>' 'no axis'
try '<link name="a"/><link name="b"/><joint name="j" type="revolute">
<parent link="a"/><child link="b"/><origin xyz="0 0"/></joint>' 'two numbers'
try '<link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>
<joint name="k" type="fixed"><parent link="a"/><child link="b"/></joint>' 'two parents'
try '<link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>
<joint name="k" type="fixed"><parent link="b"/><child link="a"/></joint>' 'a circle'
try '<xacro:include filename="x"/>' 'xacro'
try '<link name="${prefix}a"/>' 'xacro'
try '<link name="a">' 'not closed'
try '<link name="a"><inertial><mass value="-1"/></inertial></link>' 'refused by the model'
try "<link name=\"a\"/><link name=\"b\">$mass</link><joint name=\"j\" type=\"revolute\">
<parent link=\"a\"/><child link=\"b\"/><mimic joint=\"k\"/></joint>" 'follows nothing'
echo '<sdf/>' >no.urdf
cotree -q -e 'import urdf "no.urdf"' 2>&1
echo 'nothing' >no.urdf
cotree -q -e 'import urdf "no.urdf"' 2>&1
true
