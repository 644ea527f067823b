"""Tables of published cars, written for these tests in the words and units that people use.

Each has its source, and the plain figures of the source from which a test computes loads and frequencies by hand.
"""

from pathlib import Path
from typing import NamedTuple

import openpyxl  # type: ignore[import-untyped]

POUND_FORCE, FOOT, POUND, POUND_INCH = 4.4482216152605, 0.3048, 0.45359237, 175.12683524647636


class MadeTable(NamedTuple):
    """A table and what the source says in SI units: by axle where two are given.

    Attributes:
        source: publication.
        name: name of the file.
        text: its content; of an XLSX file each sheet below its title in brackets, cells with semicolons between them.
        kerb: mass [kg].
        front: load of the front axle [kg].
        unsprung, wheel_rate, tyre: of an axle [kg], of a wheel [N/m].
        ride: tolerance of the ride frequencies; 0.02 where the linkage has rubber in the car and none in the source.
    """

    source: str
    name: str
    text: str
    kerb: float
    front: float
    unsprung: tuple[float, float]
    wheel_rate: tuple[float, float]
    tyre: tuple[float, float]
    ride: float = 5e-3

    def write(self, folder: Path) -> Path:
        """Write the file of the table."""
        path = folder / self.name
        if path.suffix != ".xlsx":
            path.write_text(self.text, encoding="utf-8")
            return path
        book = openpyxl.Workbook()
        book.remove(book.active)
        for line in self.text.splitlines():
            if line.startswith("["):
                sheet = book.create_sheet(line.strip("[]"))
                continue
            sheet.append([float(cell) if cell.replace(".", "").isdigit() else cell or None for cell in line.split(";")])
        book.save(path)
        return path


ESCORT = MadeTable(
    "CommonRoad vehicle models 2017, vehicle 1 (Ford Escort)", "escort.csv",
    """# symbols of the publication, SI units
parameter,value,unit,comment
m,1225.887,kg,vehicle mass
m_s,1094.5427,kg,sprung mass
m_uf,65.672321,kg,unsprung mass front
m_ur,65.672321,kg,unsprung mass rear
a,0.88392,m,distance from front axle
b,1.50876,m,distance from rear axle
l,4.298,m,length
I_Phi_s,244.0472306,kg m^2,
I_y_s,1342.259768,kg m^2,
I_z,1538.853371,kg m^2,
K_sf,21898.332429,N/m,
K_sdf,1459.390294,N s/m,
K_sr,21898.332429,N/m,
K_sdr,1459.390294,N s/m,
T_f,1.389888,m,
T_r,1.423416,m,
K_tsf,-12880.270,N m/rad,normally negative
h_s,0.59436,m,
R_w,0.344,m,
K_zt,189785.5477,N/m,
""",
    1225.887, 1225.887 * 1.50876 / 2.39268, (65.672321, 65.672321), (21898.332429, 21898.332429),
    (189785.5477, 189785.5477),
)  # fmt: skip

BMW = MadeTable(
    "CommonRoad vehicle models 2017, vehicle 2 (BMW 320i), in the units of its source", "bmw.csv",
    """Parameter;Value;Unit
vehicle mass;74.91452;slug
sprung mass;66.17221;slug
unsprung mass front;4.371153;lb s^2/ft
unsprung mass rear;4.371153;lb s^2/ft
distance from CG to front axle;3.793293;ft
distance from CG to rear axle;4.667707;ft
moment of inertia for sprung mass in roll;152.871;slug ft^2
moment of inertia for sprung mass in pitch;1154.888;slug ft^2
suspension spring rate (front);1675;lbf/ft
suspension damping rate (front);122.3966;lbf s/ft
suspension spring rate (rear);1345;lbf/ft
suspension damping rate (rear);112.9981;lbf s/ft
track width front;4.55;ft
track width rear;4.475;ft
vertical spring rate of tire;10842.89;lbf/ft
center of gravity height of total mass;1.886053;ft
effective wheel/tire radius;0.344;m
lateral spring rate at compliant pin joint;12000;lbf/ft
""",
    74.91452 * POUND_FORCE / FOOT, 74.91452 * POUND_FORCE / FOOT * 4.667707 / 8.461,
    (4.371153 * POUND_FORCE / FOOT,) * 2, (1675 * POUND_FORCE / FOOT, 1345 * POUND_FORCE / FOOT),
    (10842.89 * POUND_FORCE / FOOT,) * 2,
)  # fmt: skip

VANAGON = MadeTable(
    "CommonRoad vehicle models 2017, vehicle 3 (VW Vanagon), rounded to German data-sheet units", "vanagon.csv",
    """Fahrzeug;Transporter;
Größe;Wert;Einheit
Leergewicht;1478,9;kg
Achslast vorne;790,3;kg
Radstand;2.471,9;mm
Spurweite vorn;1574,3;mm
Spurweite hinten;1543,8;mm
Schwerpunkthöhe;747,8;mm
Reifen Radius dynamisch;344;mm
ungefederte Masse Vorderachse;81,1;kg
ungefederte Masse Hinterachse;81,1;kg
Radrate vorn;33,6;N/mm
Radrate hinten;39,1;N/mm
Reifensteifigkeit;212,6;N/mm
""",
    1478.9, 790.3, (81.1, 81.1), (33600.0, 39100.0), (212600.0, 212600.0),
)  # fmt: skip

HALF_CAR = MadeTable(
    "half car with seat and rider (ride comfort with semi-active suspension), doubled to a car", "half_car.csv",
    """name,front,rear,unit
unsprung mass (per wheel),60,60,kg
suspension stiffness,16.812,16.812,N/mm
suspension damping,1000,1000,N s/m
tyre vertical stiffness,190,190,kN/m
track,1480,1480,mm

name,value,unit
sprung mass,1150,kg
wheelbase,2800,mm
CG to front axle,1350,mm
CG height,0.55,m
tyre radius,300,mm
""",
    1390.0, 1150.0 * 1.45 / 2.8 + 120.0, (120.0, 120.0), (16812.0, 16812.0), (190e3, 190e3),
)  # fmt: skip

SPORTS = MadeTable(
    "ADTM 1.4 (TU Munich), sports car: rates at the spring and motion ratios", "sports.csv",
    """Whole car weight,1500 kg
Wheelbase,2.475 m
trackFA,1.515 m
trackRA,1.530 m
weight distribution front,50 %
CoG height,0.45
spring rate front,80 N/mm
spring rate rear,90 N/mm
motion ratio front,0.95238
motion ratio rear,0.83333
unsprung mass FL,40 kg
unsprung mass FR,40 kg
unsprung mass RL,40 kg
unsprung mass RR,40 kg
tyre rate,280 N/mm
tyre radius,0.33
""",
    1500.0, 750.0, (80.0, 80.0), (80e3 * 0.95238**2, 90e3 * 0.83333**2), (280e3, 280e3),
)  # fmt: skip

CORNERS = MadeTable(
    "half car of an ambulance on ride rates, doubled to a car, as corner weights", "corners.csv",
    """corner weight FL [kg],520
corner weight FR [kg],520
corner weight RL [kg],480
corner weight RR [kg],480
front axle unsprung mass [kg],120
rear axle unsprung mass [kg],160
wheelbase [mm],3000
ride rate front [N/mm],26.78571
ride rate rear [N/mm],30.70175
tire stiffness [N/mm],250
cg height [mm],700
loaded radius [mm],330
""",
    2000.0, 1040.0, (120.0, 160.0), (30e3, 35e3), (250e3, 250e3),
)  # fmt: skip

CHRONO = MadeTable(
    "Project Chrono, BMW E90 front suspension (SAE 2007-01-0818), rear axle assumed", "e90.csv",
    """# axes: x forward, y left, z up, origin in the middle of the front axle; left side
point,axle,x [m],y [m],z [m]
wheel centre,front,0,0.750062,0
"lower control arm, rear point on the body",front,-0.04318,0.37338,-0.12573
"lower control arm, front point on the body",front,0.27051,0.34544,-0.05969
lower ball joint,front,0.02794,0.66294,-0.10414
strut top,front,-0.08382,0.54102,0.46863
strut lower point,front,-0.00508,0.61976,-0.00127
wheel centre,rear,-2.75717,0.7493,0

name,value,unit
total mass,1650,kg
front axle load,842,kg
unsprung mass of the front axle,95,kg
unsprung mass of the rear axle,80,kg
wheel rate front,24.5,N/mm
wheel rate rear,26,N/mm
tyre stiffness,310.526,N/mm
loaded tyre radius,0.305,m
""",
    1650.0, 842.0, (95.0, 80.0), (24500.0, 26000.0), (310526.0, 310526.0),
)  # fmt: skip

SEVEN_DOF = MadeTable(
    "ride model of a passenger car, ISRN Mechanical Engineering 2015, 974020, table 2; CoG of the body",
    "seven_dof.xlsx",
    """[Data]
Full car model

Parameter;Value;Unit
Sprung mass;1460;kg
Roll moment of inertia (body);460;kg·m²
Pitch moment of inertia (body);2460;kg·m²
Distance CG - front axle;1.011;m
Distance CG - rear axle;1.803;m
Width of track;1.51;m

Wheel;Unsprung mass [kg];Suspension stiffness [N/m];Suspension damping [N·s/m];Tyre stiffness [N/m]
FL;40;19960;1290;175500
FR;40;19960;1290;175500
RL;35.5;17500;1690;175500
RR;35.5;17500;1690;175500
""",
    1611.0, 1460.0 * 1.803 / 2.814 + 80.0, (80.0, 71.0), (19960.0, 17500.0), (175500.0, 175500.0),
)  # fmt: skip

HEAVE = MadeTable(
    "MathWorks, Vehicle Dynamics 14DOF (heave and roll of axles), rims added to the unsprung masses", "heave.xlsx",
    """[Axles]
Vehicle data sheet
Parameter;Front axle;;Rear axle;
;Value;Unit;Value;Unit
Heave stiffness (per axle);40;kN/m;50;kN/m
Heave damping (per axle);3.5;kN s/m;3.5;kN s/m
Track width;1600;mm;1600;mm
Unsprung mass of the axle incl. rims;115;kg;110;kg
Tyre vertical stiffness;239.45;kN/m;239.45;kN/m
[Body]
Body mass;kg;1600
Wheelbase;mm;3000
CG behind front axle (body);mm;1500
CG height (body);mm;614.7
Tyre free radius;mm;350

Inertia tensor of the body [kg m^2];x;y;z
x;600;0;0
y;0;3000;0
z;0;0;3200
""",
    1825.0, 915.0, (115.0, 110.0), (20000.0, 25000.0), (239450.0, 239450.0),
)  # fmt: skip

SCRIPT = MadeTable(
    "full-vehicle model as it is quoted from Ikenaga, Lewis, Campos, Davis, American Control Conference 2000 (the "
    "paper itself was not read)", "script.m",
    """% full vehicle model
ms = 1500;      % sprung mass, kg
mus = 59;       % unsprung mass at each wheel, kg
Ixx = 460;      % kg m^2
Iyy = 2160;     % kg m^2
ksf = 35000;    % front suspension spring, N/m
ksr = 38000;    % rear suspension spring, N/m
csf = 1000;     % N s/m
csr = 1100;     % N s/m
kt = 190000;    % N/m
a = 1.4;        % CG to front axle, m
b = 1.7;        % CG to rear axle, m
""",
    1736.0, 1500.0 * 1.7 / 3.1 + 118.0, (118.0, 118.0), (35000.0, 38000.0), (190e3, 190e3),
)  # fmt: skip

US_UNITS = MadeTable(
    "seven-degree-of-freedom ride exercise (1200 kg, a 1.0 m, b 1.1 m, wheels 30 kg, 16 and 18 kN/m, tyres 150 kN/m), "
    "rounded in US units", "us_units.csv",
    """Item,Front,Rear,Units
Total weight,2645.5,,lb
Weight distribution,52.4/47.6,,%
Unsprung weight per wheel,66.14,66.14,lb
Spring rate at wheel,91.36,102.78,lb/in
Shock rate at wheel,30.83,30.83,lb-s/in
Tire rate,856.5,856.5,lb/in
Track,47.24,47.24,in
Wheelbase,82.68,,in
""",
    2645.5 * POUND, 0.524 * 2645.5 * POUND, (132.28 * POUND,) * 2, (91.36 * POUND_INCH, 102.78 * POUND_INCH),
    (856.5 * POUND_INCH,) * 2,
)  # fmt: skip

WISHBONES = MadeTable(
    "Project Chrono, VW T2 front double wishbones, in SAE axes with decimal commas; the ratio of the spring, 0.4518, "
    "from the velocities of the linkage with ideal joints", "wishbones.csv",
    """Fahrzeug;VW T2
Achsen: SAE J670 (x vorn, y rechts, z unten); Ursprung Mitte Vorderachse

Vorderachse;x [mm];y [mm];z [mm]
Radmitte;-40,0;697,5;26,0
Oberer Querlenker vorn;-48,0;233,5;-245,0
Oberer Querlenker hinten;-268,0;265,5;-196,0
Oberes Traggelenk;-53,0;503,5;-215,0
Unterer Querlenker vorn;223,0;94,5;0,0
Unterer Querlenker hinten;-223,0;95,4;0,0
Unteres Traggelenk;-36,0;574,5;118,0
Spurstange innen;-250,0;200,0;-54,0
Spurstange außen;-176,0;599,0;16,0
Feder oben;104,0;297,5;-197,0
Feder unten;97,0;330,5;47,0
Dämpfer oben;104,0;297,5;-323,0
Dämpfer unten;97,0;330,5;47,0

Hinterachse;;;
Radmitte;-2400,0;697,5;26,0

Gesamtfahrzeug;Wert;Einheit
Aufbaumasse;2.321,0;kg
Ungefederte Masse Vorderachse;160,0;kg
Ungefederte Masse Hinterachse;150,0;kg
Abstand Schwerpunkt Aufbau zur Vorderachse;1.204,0;mm
Federsteifigkeit vorn;112,9;N/mm
Radrate hinten;28,0;N/mm
Dämpferkonstante vorn;43,29;kNs/m
Reifensteifigkeit;175;N/mm
Reifenhalbmesser (statisch);352,0;mm
Schwerpunkthöhe;660,0;mm
""",
    2631.0, 2321.0 * (1.0 - 1.204 / 2.36) + 160.0, (160.0, 150.0), (112.9e3 * 0.45176**2, 28e3),
    (175e3, 175e3), ride=0.02,
)  # fmt: skip

TABLES = (ESCORT, BMW, VANAGON, HALF_CAR, SPORTS, CORNERS, CHRONO, SEVEN_DOF, HEAVE, SCRIPT, US_UNITS, WISHBONES)
