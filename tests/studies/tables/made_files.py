"""Small files of other programs for the tests, in their words: tyre files, Adams models, a URDF car."""

TIR_52 = """[MDI_HEADER]
FILE_TYPE                ='tir'
FILE_VERSION             =3.0
FILE_FORMAT              ='ASCII'
$----------------------------------------------------------------units
[UNITS]
LENGTH                   ='meter'
FORCE                    ='newton'
ANGLE                    ='radians'
MASS                     ='kg'
TIME                     ='second'
[MODEL]
FITTYP                   =52
USE_MODE                 =4
[DIMENSION]
UNLOADED_RADIUS          =0.3135
WIDTH                    =0.205
[VERTICAL]
VERTICAL_STIFFNESS       =2.1e+005
VERTICAL_DAMPING         =50
FNOMIN                   =4000
[SCALING_COEFFICIENTS]
LFZO                     =1
LKX                      =1
LKY                      =1
[LONGITUDINAL_COEFFICIENTS]
PCX1                     =1.65
PDX1                     =1.2
PKX1                     =21.7
PKX2                     =13.5
PKX3                     =-0.4
PTX1                     =2.0
PTX2                     =0.0
[LATERAL_COEFFICIENTS]
PCY1                     =1.3
PKY1                     =-20.5
PKY2                     =1.95
PTY1                     =2.3
PTY2                     =1.9
[ALIGNING_COEFFICIENTS]
QDZ1                     =0.09
QDZ2                     =-0.009
"""

TIR_61 = (
    TIR_52.replace("FITTYP                   =52", "FITTYP                   =61")
    .replace("VERTICAL_DAMPING         =50\n", "VERTICAL_DAMPING         =50\nPFZ1 = 0.7\n")
    .replace("[VERTICAL]", "[OPERATING_CONDITIONS]\nINFLPRES = 230000\nNOMPRES = 200000\n[STRUCTURAL]\n"
             "LONGITUDINAL_STIFFNESS = 3.6e5\nLATERAL_STIFFNESS = 1.1e5\n[VERTICAL]")
    .replace("PKX3                     =-0.4", "PKX3 = -0.4\nPPX1 = -0.35\nPPX2 = 0.1")
    .replace("PKY2                     =1.95", "PKY2 = 1.95\nPKY4 = 1.9\nPPY1 = 0.6\nPPY2 = 1.2")
    .replace("QDZ1                     =0.09", "QDZ1 = 0.09\nPPZ1 = 0.5")
)  # fmt: skip

ADM = """! ADAMS/View model name: my_axle
UNITS/
, FORCE = NEWTON
, MASS = KILOGRAM
, LENGTH = MILLIMETER
, TIME = SECOND
!
PART/1
, GROUND
!                          adams_view_name='front.hpl_wheel_center'
MARKER/1, PART = 1
, QP = 0, -750, 330
!                          adams_view_name='front.hpl_lca_front'
MARKER/2, PART = 1, QP = -20, -400, 190
!                          adams_view_name='front.hpl_lca_rear'
MARKER/3, PART = 1, QP = 300, -410, 195
!                          adams_view_name='front.gel_upright'
PART/2, MASS = 9.5, CM = 20, IP = 1E5, 1E5, 1E5
, QG = 0, -700, 330, REULER = 90D, 0D, 0D
!                          adams_view_name='front.hpl_lca_outer'
MARKER/20, PART = 2, QP = -160, 10, -5
!                          adams_view_name='front.hpl_top_mount'
MARKER/4, PART = 1, QP = 45, -575, 870
"""

CMD = """defaults units &
   length = mm &
   mass = kg
!
part create rigid_body name_and_position &
   ground_part = yes &
   part_name = .car.ground
!
point create &
   point_name = .car.ground.hpl_front_wheel_center &
   location = 0.0, -750.0, 330.0
point create &
   point_name = .car.ground.hpl_front_lca_front &
   location = -20.0, -400.0, 190.0
point create &
   point_name = .car.ground.hpl_front_lca_rear &
   location = 300.0, -410.0, 195.0
point create &
   point_name = .car.ground.hpl_front_lca_outer &
   location = 5.0, -700.0, 170.0
point create &
   point_name = .car.ground.hpl_front_top_mount &
   location = 45.0, -575.0, 870.0
"""


SUB = """[MDI_HEADER]
FILE_TYPE = 'sub'
[SUBSYSTEM_HEADER]
 MAJOR_ROLE = 'suspension'
 MINOR_ROLE = 'front'
[UNITS]
LENGTH = 'mm'
MASS = 'kg'
[HARDPOINT]
{hardpoint_name          symmetry  x_value       y_value       z_value}
 'lca_front         '   'left/right'  -20.0  -400.0  190.0
 'lca_rear          '   'left/right'  300.0  -410.0  195.0
 'lca_outer         '   'left/right'  5.0  -700.0  170.0
 'top_mount         '   'left/right'  45.0  -575.0  870.0
 'tierod_outer      '   'left/right'  150.0  -720.0  280.0
 'wheel_center      '   'left/right'  0.0  -750.0  330.0
 'subframe_front    '   'left/right'  -400.0  -450.0  150.0
[PART_ASSEMBLY]
 USAGE = 'upright'
 MASS  = 12.5
[NSPRING_ASSEMBLY]
 USAGE = 'spring'
 PROPERTY_FILE = '<acar_shared>/springs.tbl/front.spr'
"""

PAR = """PARSFILE
#FullDataName Vehicle: Sprung Mass`Hatchback
M_SU 1111 ; kg ! Sprung mass
LX_CG_SU 1040 ; mm
LX_AXLE(2) 2600 ; mm ! X distance of axle 2
IAXLE 1
M_US 60
L_TRACK 1481
H_WC 298
KSPRING_L(1,1) 27 ; N/mm
KSPRING_L(1,2) 27 ; N/mm
IAXLE 2
M_US 60.5
L_TRACK 1486
ISIDE 1
KSPRING_L 30
ISIDE 2
KSPRING_L 30
FD_TABLE LINEAR
-1000, -1500
1000, 1500
ENDTABLE
OPT_BK 1
END
"""


def urdf(wheel_mass: float = 20.0, chassis: float = 1300.0) -> str:
    """Return a car of a chassis, a turned engine and four wheels; wheelbase 2.6 m, track 1.5 m, radius 0.31 m."""
    wheels = "".join(
        f"""<link name="wheel_{name}"><inertial><mass value="{wheel_mass}"/>
        <inertia ixx="0.6" iyy="1.1" izz="0.6" ixy="0" ixz="0" iyz="0"/></inertial>
        <collision><geometry><cylinder radius="0.31" length="0.2"/></geometry></collision></link>
        <joint name="hub_{name}" type="continuous"><parent link="base"/><child link="wheel_{name}"/>
        <origin xyz="{x} {y} 0.31" rpy="0 0 0"/><axis xyz="0 1 0"/></joint>"""
        for name, x, y in (("fl", 1.3, 0.75), ("fr", 1.3, -0.75), ("rl", -1.3, 0.75), ("rr", -1.3, -0.75))
    )
    return f"""<?xml version="1.0"?>
<robot name="car"><link name="base"><inertial><origin xyz="0.1 0 0.6"/><mass value="{chassis}"/>
<inertia ixx="450" iyy="1700" izz="1900" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="engine"><inertial><origin xyz="0.2 0 0"/><mass value="150"/>
<inertia ixx="10" iyy="6" izz="12" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="mount" type="fixed"><parent link="base"/><child link="engine"/>
<origin xyz="1.3 0 0.5" rpy="0 0 1.5707963267948966"/></joint>{wheels}</robot>"""
