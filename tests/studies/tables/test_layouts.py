"""Layouts of tables that once gave a wrong number without a word: other signs, columns, titles and notes."""

import math

import openpyxl  # type: ignore[import-untyped]
import pytest

from tests.studies.tables.test_car_table import POINTS, WORDS, read, require_points, rows
from vehicle.errors import VehicleError
from vehicle.studies.design.template_car import template_car
from vehicle.studies.tables.car_table import car_table

SHEET = "Hardpoint,x [mm],y [mm],z [mm]\n"
NUMBERS: dict[str, tuple[str, dict[str, float | None]]] = {
    "points between thousands, decimal comma": (
        "Grösse;Wert;Einheit\nRadstand;2.631;mm\nSpurweite;1.540,5;mm\nAchslast vorn;7.600;N\n",
        {"wheelbase": 2.631, "track_front": 1.5405, "front_axle_load": 7600.0 / 9.81}),
    "four columns of corners": (
        "Parameter,Front left,Front right,Rear left,Rear right,Unit\nCorner weight,480,482,500,505,kg\n"
        "wheel rate,30,30,28,28,N/mm\n",
        {"front_axle_load": 962.0, "rear_axle_load": 1005.0, "wheel_rate_front": 3e4, "wheel_rate_rear": 2.8e4}),
    "unit after empty cells": ("Total mass,3300,,lb\n", {"kerb_mass": 3300.0 * 0.45359237}),
    "unit after a second value": ("Total mass,3300,4000,lb\n", {"kerb_mass": 3300.0 * 0.45359237}),
    "weight as a force": ("Vehicle weight,14.715,kN\n", {"kerb_mass": 1500.0}),
    "rates of both wheels": (
        "Front wheel rate (axle),50,N/mm\nRear suspension stiffness (both springs),48,kN/m\n"
        "wheel damping front,3000,Ns/m,per axle\n",
        {"wheel_rate_front": 2.5e4, "wheel_rate_rear": 2.4e4, "wheel_damping_front": 1500.0}),
    "axle or wheel in a note": (
        "name,value,unit,comment\nunsprung mass front,48,kg,axle\nunsprung mass rear,80,kg,per wheel\n",
        {"unsprung_mass_front": 48.0, "unsprung_mass_rear": 160.0}),
    "words and symbol": (
        "Sprung mass ms,1200,kg\nUnsprung mass front mus_f,80,kg\nUnsprung mass rear mus_r,76,kg\n",
        {"kerb_mass": 1356.0, "unsprung_mass_front": 80.0, "unsprung_mass_rear": 76.0}),
    "half track": ("Half-track,765,mm\n", {"track_front": 1.53, "track_rear": 1.53}),
    "mass with driver": ("Mass with driver,300,kg\n", {"kerb_mass": 300.0}),
    "every number with its unit": ("name,value\nsprung mass front corner,375 kg\nunsprung mass front,45 kg\n",
                                   {"front_axle_load": 840.0, "unsprung_mass_front": 90.0}),
    "suspension after the axle": ("Front suspension stiffness,25,kN/m\n", {"wheel_rate_front": 2.5e4}),
    "referred to the wheel": (SHEET + rows(WORDS["front"]) + "\nFederrate vorn (radbezogen);22".replace(";", ",")
                              + ",N/mm\n", {"wheel_rate_front": 2.2e4, "spring_stiffness_front": None}),
    "height of the car": ("Height,1450,mm\nwheelbase,2.6,m\n", {"wheelbase": 2.6, "cog_height": None}),
    "units in the cells of both axles": ("Parameter,Front,Rear\nRide frequency,1.25 Hz,1.40 Hz\n",
                                         {"ride_frequency_front": 1.25, "ride_frequency_rear": 1.4}),
    "sentence on an axle": ("The car has a live rear axle.\nLive rear axle and MacPherson struts of a mid size car\n"
                            "Total mass,1900,kg\nTyre stiffness,250,N/mm\n",
                            {"kerb_mass": 1900.0, "tyre_stiffness_front": 2.5e5, "rear_axle_load": None}),
    "origin at an axle": ("# origin on the ground at the front axle\ntotal mass,1650,kg\ntyre stiffness,250,N/mm\n",
                          {"kerb_mass": 1650.0, "tyre_stiffness_rear": 2.5e5}),
    "car after the points of an axle": (
        SHEET + "Front suspension\n" + rows(WORDS["plain"]) + "\nParameter,Value,Unit\nTotal weight,1400,kg\n"
        "tyre stiffness,200,N/mm\n", {"kerb_mass": 1400.0, "tyre_stiffness_rear": 2e5}),
    "car after the points, without a header": (
        SHEET + "Front suspension\n" + rows(WORDS["plain"]) + "\ntyre stiffness,200,N/mm\n",
        {"tyre_stiffness_front": 2e5, "tyre_stiffness_rear": 2e5}),
    "a row for each axle": (
        "Axle;Track [mm];Unsprung mass [kg];Spring rate [N/mm];Motion ratio [-]\nFront;1540;90;25;0,95\n"
        "Rear;1530;80;28;0,8\n",
        {"track_rear": 1.53, "unsprung_mass_front": 90.0, "wheel_rate_front": 25e3 * 0.95**2,
         "wheel_rate_rear": 28e3 * 0.64}),
    "a row for each wheel": (
        "Rad;Radlast [N];Ungefederte Masse [kg]\nVL;4100;38\nVR;4100;38\nHL;3200;35\nHR;3200;35\n",
        {"front_axle_load": 8200.0 / 9.81, "rear_axle_load": 6400.0 / 9.81, "unsprung_mass_rear": 70.0}),
    "a row for the car, units below the header": (
        "Parameter,mass,wheelbase,track front\nUnit,kg,mm,mm\nValue,1400,2600,1500\n",
        {"kerb_mass": 1400.0, "wheelbase": 2.6, "track_front": 1.5}),
    "a row of the laden car first": ("Load case,Mass [kg],CG height [mm]\nLaden,1800,560\nEmpty,1400,540\n",
                                     {"kerb_mass": 1400.0, "cog_height": 0.54}),
    "pairs of value and unit": (
        "Parameter,Front,,Rear,\n,Value,Unit,Value,Unit\nTrack,1540,mm,1.53,m\nWheel rate,25,N/mm,28,kN/m\n",
        {"track_front": 1.54, "track_rear": 1.53, "wheel_rate_front": 25e3, "wheel_rate_rear": 28e3}),
    "the car in the column of an axle": ("Item,Front,Rear,Units\nTotal weight,3000,,lb\nTrack,60,59,in\n",
                                         {"kerb_mass": 3000.0 * 0.45359237, "front_axle_load": None}),
    "left and right below the axles": (
        "Parameter;Vorderachse;;Hinterachse;;Einheit\n;links;rechts;links;rechts;\nRadlast;410;412;310;312;kg\n",
        {"front_axle_load": 822.0, "rear_axle_load": 622.0}),
    "both axles in a cell": (
        "Achslasten (v/h);820/630;kg\nFederrate VA / HA;25,0 / 28,5;N/mm\nTrack rear/front;1530 mm / 1540 mm\n",
        {"front_axle_load": 820.0, "wheel_rate_rear": 28.5e3, "track_front": 1.54, "track_rear": 1.53}),
    "matrix of inertia": (
        "mass,1500,kg\n\nInertia tensor [kg m2],x,y,z\nx,500,0,-30\ny,0,2000,0\nz,-30,0,2200\n",
        {"roll_inertia": 500.0, "pitch_inertia": 2000.0, "yaw_inertia": 2200.0}),
    "moments in a row": ("mass,1500,kg\nInertia (Ixx Iyy Izz),500,2000,2200,kg m2\n",
                         {"roll_inertia": 500.0, "pitch_inertia": 2000.0, "yaw_inertia": 2200.0}),
    "bar rate at the wheel": ("track,1500,mm\nwheel rate front,22,N/mm\nAnti-roll bar rate at wheel front,10,N/mm\n",
                              {"roll_stiffness_front": math.radians(32e3 * 1.5**2 / 2.0)}),
    "roll stiffness and its distribution": (
        "track,1500,mm\nTotal roll stiffness,1600,Nm/deg\nRoll stiffness distribution front,60,%\n",
        {"roll_stiffness_front": 960.0, "roll_stiffness_rear": 640.0}),
    "inverse motion ratio": ("name,value,unit,comment\nspring rate front,40,N/mm,\nmotion ratio front,1.25,-,wheel "
                             "travel / spring travel\n", {"wheel_rate_front": 40e3 * 0.64}),
    "both strokes": ("Damping front compression,1000,N s/m\nDamping front rebound,3000,N s/m\n",
                     {"wheel_damping_front": 2000.0}),
    "rate with the tyre": ("Wheel rate front (incl. tyre),20,N/mm\nTyre stiffness,200,N/mm\n",
                           {"wheel_rate_front": 20e3 * 200.0 / 180.0}),
    "kilogram-force, thousands": ("spring rate front;8;kgf/mm\nspring rate rear;6;kg/mm\nmass;1 450;kg\n"
                                  "wheelbase;2'600;mm\n",
                                  {"wheel_rate_front": 8 * 9806.65, "wheel_rate_rear": 6 * 9806.65, "kerb_mass": 1450.0,
                                   "wheelbase": 2.6}),
    "limits": ("name,value,unit,comment\nKerb weight,1400,kg,\nzulässiges Gesamtgewicht,1900,kg,\n"
               "Front axle load (max),1000,kg,\nRear axle load,950,kg,permissible\n"
               "Front roll stiffness (springs only),500,Nm/deg\n",
               {"kerb_mass": 1400.0, "front_axle_load": None, "rear_axle_load": None,
                "roll_stiffness_front": None}),
    "German compounds": (
        "Fahrzeuggesamtmasse leer;1450;kg\nVorderachslast;820;kg\nAufbaufedersteifigkeit vorne (radbezogen);24,5;N/mm\n"
        "Stoßdämpferkonstante vorn;1,8;kNs/m\nReifenvertikalsteifigkeit;205;N/mm\nSchwerpunkthöhe über Boden;545;mm\n"
        "Nickträgheitsmoment;2100;kgm²\nStatischer Reifenhalbmesser;302;mm\nLehrsches Dämpfungsmaß hinten;0,3;-\n",
        {"front_axle_load": 820.0, "wheel_rate_front": 24.5e3, "wheel_damping_front": 1800.0, "cog_height": 0.545,
         "tyre_stiffness_rear": 205e3, "pitch_inertia": 2100.0, "tyre_radius": 0.302}),
    "script": ("% car\nm = 1400; % kg\nmuf = 80; % kg, axle\nL = 2.6; % wheelbase [m]\nksf=25000; % N/m\n",
               {"kerb_mass": 1400.0, "unsprung_mass_front": 80.0, "wheelbase": 2.6, "wheel_rate_front": 25e3}),
    "quarter car": ("Quarter car\nSprung mass,300,kg\nUnsprung mass,40,kg\nwheelbase,2.6,m\n",
                    {"kerb_mass": 1360.0, "unsprung_mass_rear": 80.0}),
    "quarter car in a long title": (
        "Quarter car model of a passenger car\nm_s;sprung mass;290;kg\nm_us;unsprung mass per wheel;59;kg\n",
        {"kerb_mass": 4 * (290.0 + 59.0), "unsprung_mass_rear": 118.0}),
    "no bar": ("wheel rate rear,28,N/mm\ntrack rear,1500,mm\nanti-roll bar rate rear,0,Nm/deg\n",
               {"roll_stiffness_rear": 0.5 * 28e3 * 1.5**2 * math.pi / 180.0}),
    "data sheet": ("Masses of front and rear\nItem\tData\nKerb weight DIN (kg)\t2,140\n"
                   "Weight distribution front/rear\t48:52\n"
                   "Tyres\t235/60 R18 107V\nSpring rate front (two wheels)\t64.5 N/mm\n"
                   "Rear spring rate (left + right)\t50 N/mm\n",
                   {"kerb_mass": 2140.0, "front_axle_load": 0.48 * 2140.0,
                    "wheel_rate_front": 32250.0, "wheel_rate_rear": 25000.0}),
    "left and right hand": ("name,front,rear,unit\nCorner weight LH,290,410,lb\nCorner weight RH,290,410,lb\n",
                            {"front_axle_load": 580 * 0.45359237, "rear_axle_load": 820 * 0.45359237}),
    "below a title of corners": ("Corner weights\nFL,410,kg\nTotal mass,1450,kg\n", {"kerb_mass": 1450.0}),
    "lumped model": ("ms,1200,kg\nmuf,80,kg\nmur,70,kg\na,1.1,m\nb,1.5,m\n",
                     {"cog_x": round((1200 * 1.1 + 70 * 2.6) / 1350.0, 6), "unsprung_mass_rear": 70.0}),
    "rows that are counted": ("1;Kerb mass;1400;kg\n2;Wheelbase;2600;mm\n3;Track front;1540;mm\n",
                              {"kerb_mass": 1400.0, "track_front": 1.54}),
}  # fmt: skip


@pytest.mark.parametrize("case", NUMBERS)
def test_numbers_of_a_layout(case, tmp_path):
    text, wanted = NUMBERS[case]
    table = read(tmp_path, text, name="car.csv")
    for key, value in wanted.items():
        number = table.numbers.get(key)
        assert number is None if value is None else number == pytest.approx(value, rel=1e-9), key


def test_further_values_of_a_row_are_left_out_by_name(tmp_path):
    table = read(tmp_path, "Parameter,Car A,Car B,Unit\nTotal mass,1400,1800,kg\n", name="car.csv")
    assert table.numbers["kerb_mass"] == 1400.0
    assert any("further values 1800" in text for _, text in table.left_out)
    table = read(tmp_path, "Parameter,Laden,Unladen,Unit\nTotal mass,1800,1400,kg\n", name="car.csv")
    assert table.numbers["kerb_mass"] == 1400.0 and any("'Laden'" in text for _, text in table.left_out)


def test_a_motion_ratio_above_one_is_a_guess(tmp_path):
    table = read(tmp_path, "spring rate front,20,N/mm\nmotion ratio front,1.1,-\n", name="car.csv")
    assert table.numbers["wheel_rate_front"] == pytest.approx(1.1**2 * 2e4, rel=1e-12)
    assert any("spring travel per wheel travel" in text for _, text in table.guessed)


OPTIMUM = ("Wheel Center", "CHAS_LowFor", "CHAS_LowAft", "UPRI_LowPnt", "strut top")
LAYOUTS = {
    "points as columns": "Point," + ",".join(WORDS["plain"]) + "\n" + "\n".join(
        ",".join((f"{axis} [mm]", *(f"{1e3 * at[index]:.6f}" for at in POINTS.values())))
        for index, axis in enumerate("xyz")) + "\n",
    "title of the axle in the head, both sides": "Front,X,Y,Z,X,Y,Z\n" + "\n".join(
        f"{name},{1e3 * x:.6f},{1e3 * y:.6f},{1e3 * z:.6f},{1e3 * x:.6f},{-1e3 * y:.6f},{1e3 * z:.6f}"
        for name, (x, y, z) in zip(OPTIMUM, POINTS.values(), strict=True)) + "\n",
    "inches in a sentence": "ISO 8855 axes (x forward, y left, z up), inches, left side points\nname,x,y,z\n"
                            + rows(WORDS["plain"], (-1, -1, 1), side=-1.0, unit=1.0 / 0.0254),
}  # fmt: skip


@pytest.mark.parametrize("layout", LAYOUTS)
def test_points_of_a_layout(layout, tmp_path):
    require_points(read(tmp_path, LAYOUTS[layout]))


@pytest.mark.parametrize("head", ["Points,Front,,,Rear,,\n,x,y,z,x,y,z\n",
                                  "Point,Front x [mm],Front y [mm],Front z [mm],Rear x,Rear y,Rear z\n"])  # fmt: skip
def test_both_axles_beside_each_other(head, tmp_path):
    lines = []
    for name, key in (("wheel centre", "wheel_center"), ("strut top", "strut_top")):
        x, y, z = (1e3 * value for value in POINTS[key])
        lines.append(f"{name},{x:.6f},{y:.6f},{z:.6f},{x + 2600.0:.6f},{y - 10.0:.6f},{z:.6f}")
    table = read(tmp_path, "axes: x rearward, y right, z up\n\n" + head + "\n".join(lines) + "\n", name="car.csv")
    assert table.numbers["wheelbase"] == pytest.approx(2.6, abs=1e-9)
    assert table.points["front"]["strut_top"] == pytest.approx(POINTS["strut_top"], abs=1e-9)
    assert table.points["rear"]["damper_upper"] == pytest.approx((0.03, 0.56, 0.56), abs=1e-9)


VECTORS = ("{};({}, {}, {})\n", "{};{}/{}/{}\n", "{} = [{} {} {}]; % mm\n")


@pytest.mark.parametrize("form", VECTORS)
def test_three_coordinates_in_a_cell(form, tmp_path):
    lines = [form.format(name, *(f"{1e3 * value:.3f}" for value in at))
             for name, at in zip(WORDS["plain"], POINTS.values(), strict=True)]  # fmt: skip
    require_points(read(tmp_path, "axes: adams, mm\n" + "".join(lines)))


def test_rods_of_an_axle_of_five_links(tmp_path):
    rods = {"upper trailing link wheel side": "trailing_upper_outer",
            "lower trailing link body": "trailing_lower_inner",
            "upper lateral link inner": "upper_inner", "upper lateral link outer": "upper_outer",
            "toe link outer": "lower_front_outer", "lower front link inner": "lower_front_inner",
            "spring link outer": "lower_rear_outer"}  # fmt: skip
    lines = [f"{name},{2.6 + 0.01 * n},{0.7 - 0.02 * n},{0.3 + 0.03 * n}" for n, name in enumerate(rods)]
    text = "axes: adams\nRear axle,x [m],y [m],z [m]\nwheel centre,2.6,0.75,0.3\n" + "\n".join(lines) + "\n"
    (tmp_path / "car.csv").write_text(text)
    table = car_table([tmp_path / "car.csv"], template_car("focus_road").point_names)
    for n, name in enumerate(rods.values()):
        assert table.points["rear"][name] == pytest.approx((0.01 * n, 0.7 - 0.02 * n, 0.03 * n), abs=1e-9), name


def test_german_words_of_axes_and_origin(tmp_path):
    text = ("Achsen: x nach hinten, y nach rechts, z nach oben; Ursprung Vorderachse\nPunkt,x [mm],y [mm],z [mm]\n"
            "Radmitte hinten,2700,750,300\nFederbein oben hinten,2730,570,860\n")  # fmt: skip
    table = read(tmp_path, text, name="car.csv")
    assert table.points["rear"]["damper_upper"] == pytest.approx((0.03, 0.57, 0.56), abs=1e-9)


BUSHINGS = {
    "words": "Bushing,Axle,Translational stiffness x [N/mm],stiffness y,stiffness z,Preload [N]\n"
             "LCA rear,front,800,900,500,7\n",
    "unit in a column": "Lager;Kx;Ky;Kz;Einheit\nvorn Querlenker hinten;800;900;500;N/mm\n",
    "unit in the title": "Bushing stiffness (N/mm),x,y,z\nfront lower arm rear,800,900,500\n",
}  # fmt: skip


@pytest.mark.parametrize("case", BUSHINGS)
def test_bushings_of_a_layout(case, tmp_path):
    table = read(tmp_path, BUSHINGS[case], name="car.csv")
    assert table.parameters["front", "bushings.arm_rear.stiffness"][0] == [8e5, 9e5, 5e5]
    assert ("Preload" in BUSHINGS[case]) == any("Preload" in text for _, text in table.left_out)


SHARES = ("distribution,55/45,%", "distribution F:R,55:45", "distribution,55 % front", "distribution,45 % rear",
          "distribution,55% front / 45% rear", "distribution rear/front,45/55,%")  # fmt: skip


@pytest.mark.parametrize("share", SHARES)
def test_a_mass_distribution_as_text(share, tmp_path):
    table = read(tmp_path, f"mass,1500,kg\nWeight {share}\n", name="car.csv")
    assert table.numbers["front_axle_load"] == pytest.approx(825.0, rel=1e-12)


STROKES = [(-0.5, -500.0), (-0.1, -200.0), (0.1, 400.0), (0.5, 1200.0)]
CURVES = {
    "strokes": "Damper front\nv [mm/s],Rebound [N],Compression [N]\n100,400,200\n500,1200,500\n",
    "negative strokes": "Damper front\nv [m/s],compression [N],rebound [N]\n-0.1,-200,-400\n-0.5,-500,-1200\n",
    "velocities along a row": "Damper front,,\nVelocity [mm/s],100,500\nRebound [N],400,1200\n"
                              "Compression [N],200,500\n",
    "axles": "v [m/s],F rear [N],F front [N]\n-0.5,-1,-500\n-0.1,-1,-200\n0.1,1,400\n0.5,1,1200\n",
    "axles and strokes": "v [m/s],front rebound [N],front compression [N],rear rebound [N],rear compression [N]\n"
                         "0.1,400,200,1,1\n0.5,1200,500,1,1\n",
    "force first": "Dämpfer vorn\nKraft [daN];Geschwindigkeit [m/s]\n-50;-0,5\n-20;-0,1\n40;0,1\n120;0,5\n",
}  # fmt: skip


def test_texts_and_numbers_of_a_sheet_have_points_of_their_own(tmp_path):
    book = openpyxl.Workbook()
    for row in (("Leergewicht", "2.050", "kg"), ("Achslast vorne", "1.185,0", "kg"), ("Radstand", 3.45, "m"),
                ("Spurweite vorn", 1.734, "m"), ("Spurweite hinten", "1.716", "mm"),
                ("Bereifung", "235/60 R18 107V")):  # fmt: skip
        book.active.append(row)
    book.save(tmp_path / "van.xlsx")
    numbers = car_table([tmp_path / "van.xlsx"], template_car("sedan").point_names, {}).numbers
    assert numbers == {"kerb_mass": 2050.0, "front_axle_load": 1185.0, "wheelbase": 3.45, "track_front": 1.734,
                       "track_rear": 1.716, "tyre_size": "235/60 R18 107V"}  # fmt: skip


def test_a_number_that_others_replace_is_named(tmp_path):
    table = read(tmp_path, "mass,1400,kg\nroll stiffness front,60,kNm/rad\nroll stiffness total,100,kNm/rad\n"
                 "front damper constant,1500,Ns/m\nfront damping ratio,0.3\n", name="car.csv")  # fmt: skip
    assert [text.split(" =")[0] for _, text in table.left_out] == ["roll stiffness total", "front damping ratio"]


def test_a_row_without_its_number_is_named(tmp_path):
    table = read(tmp_path, "name,value,unit\nmass,#REF!,kg\nwheelbase,2.6,m\n\nname,front,rear\ntrack [m],1.5,TBD\n",
                 name="car.csv")  # fmt: skip
    assert table.numbers == {"wheelbase": 2.6, "track_front": 1.5}
    assert ["#REF!" in text or "TBD" in text for _, text in table.left_out] == [True, True]


@pytest.mark.parametrize("case", CURVES)
def test_damper_curves_of_a_layout(case, tmp_path):
    table = read(tmp_path, CURVES[case], name="car.csv")
    assert [value for row in table.curves["front"] for value in row] == pytest.approx(
        [value for row in STROKES for value in row], rel=1e-12
    )


BAD = {
    "several forces of a damper": (
        "Damper front\nv [m/s],force 0 A [N],force 1 A [N]\n-0.1,-2,-4\n0.1,2,4\n",
        "several columns of force",
    ),
    "shares": ("mass,1400,kg\nWeight distribution,55/55,%\n", "sum up to 1.1"),
    "matrix": ("mass,1400,kg\n\nInertia [kg m2],x,y,z\nx,500,0,-30\ny,0,2000,0\nz,30,0,2200\n", "not symmetric"),
    "US units": ("Units: US customary\nmass,3200\nwheelbase,2600,mm\n", "states 'US customary'"),
    "heave of an axle or a wheel": ("Heave stiffness front,40,kN/m\n", "of a wheel or of both"),
    "sprung mass of an axle or a wheel": (
        "sprung mass front,400,kg\nunsprung mass front axle,80,kg\n",
        "of a wheel or of an axle",
    ),
    "total of a rate": ("Front suspension stiffness (total),50,N/mm\n", "of a wheel or of both"),
    "half of a car": ("Half-car model\nm_s,900,kg\nm_uf,40,kg\nm_ur,45,kg\n", "a quarter, a half or the whole"),
    "light body": ("m_s,690,kg\nm_uf,40,kg\nm_ur,45,kg\n", "a quarter, a half or the whole"),
    "one stroke": ("Damping front rebound,3000,N s/m\n", "of one stroke"),
    "all wheels": ("Total unsprung mass,90,kg\n", "of an axle or of all wheels"),
    "all wheels by size": ("Unsprung mass,160,kg\n", "of an axle or of all wheels"),
    "points of two meanings": ("mass;1.400;kg\nwheelbase;2,6;m\ntrack;1.5;m\n", "thousand or a decimal"),
}


@pytest.mark.parametrize("case", BAD)
def test_a_number_of_two_meanings_is_refused(case, tmp_path):
    text, message = BAD[case]
    with pytest.raises(VehicleError, match=message):
        read(tmp_path, text, name="car.csv")
