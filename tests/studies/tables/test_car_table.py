"""Words, units and axes of tables: each variant gives the same points and numbers; what is ambiguous is refused."""

import math

import openpyxl  # type: ignore[import-untyped]
import pytest

from vehicle.commands.new import main
from vehicle.engines.kinematics.axle_ride import axle_ride
from vehicle.errors import VehicleError
from vehicle.runs.car import Car
from vehicle.studies.design.axle_types import AXLE_TYPES, axle_type_names
from vehicle.studies.design.new_car import new_car
from vehicle.studies.design.stated_numbers import stated_numbers
from vehicle.studies.design.template_car import template_car
from vehicle.studies.design.written_table import table_lines
from vehicle.studies.tables.car_table import car_table
from vehicle.studies.tables.unit_factor import unit_factor

NAMES = template_car("sedan").point_names
TYPES = {name: axle_type_names(name) for name in AXLE_TYPES}

POINTS = {"wheel_center": (0.0, 0.75, 0.0), "arm_front": (-0.15, 0.38, -0.12), "arm_rear": (0.16, 0.385, -0.115),
          "lower_ball": (0.0, 0.7, -0.13), "strut_top": (0.03, 0.57, 0.56)}  # fmt: skip
"""Points of the variants, relative to the wheel centre: x to the rear, y to the right, z up [m]."""

WORDS = {
    "plain": ("wheel centre", "lower control arm front", "lower control arm rear", "lower ball joint", "strut top"),
    "adams": ("hpl_wheel_center", "hpl_lca_front", "hpl_lca_rear", "hpl_lca_outer", "hpl_top_mount"),
    "letters": ("WC", "LCA_F", "LCA_R", "LBJ", "STRUT TOP"),
    "optimum": ("Wheel Centre FL", "Lower Wishbone Front Pivot FL", "Lower Wishbone Rear Pivot FL",
                "Lower Ball Joint FL", "Strut Top FL"),
    "camel": ("wheelCenter", "lowerArmFrontPivot", "lowerArmRearPivot", "lowerBallJoint", "strutTopMount"),
    "german": ("Radmitte", "Querlenker vorn", "Querlenker hinten", "Traggelenk", "Federbein oben"),
    "front": ("front wheel center", "front lca front", "front lca rear", "front lower ball joint", "front strut top"),
}  # fmt: skip

FRAMES = {"x rearward, y right, z up": (1, 1, 1), "x forward, y left, z up": (-1, -1, 1),
          "x forward, y right, z down": (-1, 1, -1)}  # fmt: skip


def read(folder, *texts, name="front.csv"):
    files = []
    for index, text in enumerate(texts):
        files.append(folder / (name if index == 0 else f"{index}{name}"))
        files[-1].write_text(text, encoding="utf-8")
    return car_table(files, NAMES, TYPES)


def rows(words, frame=(1, 1, 1), *, side=1.0, unit=1e3, origin=(1.4, 0.0, 0.3), sign=","):
    """Return the rows of the points in a frame with its origin ahead of and below the wheel centre."""
    lines = []
    for word, at in zip(words, POINTS.values(), strict=True):
        place = [at[0] + origin[0], side * at[1], at[2] + origin[2]]
        lines.append(
            sign.join((word, *(f"{unit * turn * value:.9f}" for turn, value in zip(frame, place, strict=True))))
        )
    return "\n".join(lines) + "\n"


def require_points(table, axle="front"):
    for name, at in POINTS.items():
        assert table.points[axle][name] == pytest.approx(at, abs=1e-9), name
    assert table.numbers[f"track_{axle}"] == pytest.approx(1.5, abs=1e-9)


@pytest.mark.parametrize("words", WORDS)
def test_points_are_known_by_their_words(words, tmp_path):
    side = 1.0 if words in ("plain", "letters", "camel", "german", "front") else -1.0
    require_points(read(tmp_path, "name,x [mm],y [mm],z [mm]\n" + rows(WORDS[words], side=side)))


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_points_are_turned_into_the_frame_of_the_vehicle(frame, side, tmp_path):
    text = f"axes: {frame}\nname,x,y,z\n" + rows(WORDS["plain"], FRAMES[frame], side=side)
    table = read(tmp_path, text)
    require_points(table)
    assert frame in table.axes and any("without a unit: mm" in guess for _, guess in table.guessed)
    # Without the remark the points themselves show x and z.
    require_points(read(tmp_path, text.partition("\n")[2]))


@pytest.mark.parametrize(("head", "unit"), [("name,x [m],y [m],z [m]", 1.0),
                                            ("name,x (in),y (in),z (in)", 1 / 0.0254),
                                            ("Units: mm\n\npoint,X,Y,Z", 1e3),
                                            ("name,x_mm,y_mm,z_mm", 1e3)])  # fmt: skip
def test_units_of_points(head, unit, tmp_path):
    require_points(read(tmp_path, f"{head}\n" + rows(WORDS["plain"], unit=unit)), "front")


def test_units_in_a_column_and_decimal_commas(tmp_path):
    lines = rows(WORDS["german"], sign=";").replace(".", ",").splitlines()
    require_points(read(tmp_path, "Punkt;X;Y;Z;Einheit\n" + "\n".join(f"{line};mm" for line in lines)))


def test_both_axles_of_one_sheet_each_with_numbers_and_a_damper(tmp_path):
    book = openpyxl.Workbook()
    sheets = [book.active, *(book.create_sheet() for _ in range(3))]
    for sheet, title in zip(sheets, ("Front", "Rear axle", "Masses", "Damper front"), strict=True):
        sheet.title = title
    for sheet, shift in ((sheets[0], 0.0), (sheets[1], 2650.0)):
        sheet.append(["Point", "X [mm]", "Y [mm]", "Z [mm]"])
        for word, at in zip(WORDS["plain"], POINTS.values(), strict=True):
            sheet.append([word, 1e3 * at[0] + shift, -1e3 * at[1], 1e3 * at[2] + 300.0])
    for row in (["Parameter", "Value", "Unit"], ["Curb weight", 1500, "kg"], ["Front axle load", 820, "kg"]):
        sheets[2].append(row)
    sheets[3].append(["velocity [mm/s]", "force [N]"])
    for point in ([-1000, -1200], [-100, -300], [100, 500], [1000, 2500]):
        sheets[3].append(point)
    book.save(tmp_path / "car.xlsx")
    table = car_table([tmp_path / "car.xlsx"], NAMES, TYPES)
    require_points(table)
    assert table.numbers["wheelbase"] == pytest.approx(2.65) and table.numbers["kerb_mass"] == 1500.0
    assert table.curves == {"front": [(-1.0, -1200.0), (-0.1, -300.0), (0.1, 500.0), (1.0, 2500.0)]}
    # The rear axle of the sedan is a twist beam: of a strut axle its wheel centre alone is used.
    assert list(table.points["rear"]) == ["wheel_center"]
    assert any("no lower arm" in text for _, text in table.left_out)
    result = new_car("mine", "sedan", stated_numbers(None, {}, table.numbers), table)
    assert result.car.vehicle.table["front"]["damper"]["force"] == [-1200.0, -300.0, 500.0, 2500.0]


def test_a_title_in_the_head_of_the_names_names_axle_and_unit(tmp_path):
    text = "FRONT SUSPENSION (mm),X,Y,Z\n" + rows(WORDS["plain"])
    text += "REAR SUSPENSION (mm),X,Y,Z\n" + rows(WORDS["plain"], origin=(4.1, 0.0, 0.3))
    table = read(tmp_path, text, name="car.csv")
    require_points(table)
    assert table.numbers["wheelbase"] == pytest.approx(2.7) and not table.guessed


def test_other_axles_keep_the_ride_frequencies_of_the_template(tmp_path):
    """The lever of the spring of a double wishbone is shorter; the spring is stiffer for it."""
    arms = "\n".join(("lower arm rear,250,320,-80", "lower arm front,-150,320,-94", "lower ball joint,-13,737,-145",
                      "upper arm rear,105,435,196", "upper arm front,-122,435,230", "upper ball joint,25,680,162",
                      "wheel centre,0,757.5,0"))  # fmt: skip
    table = read(tmp_path, f"name,x [mm],y [mm],z [mm]\n{arms}\n")
    car = new_car("mine", "sedan", stated_numbers(None, {}, table.numbers), table).car
    rides = (axle_ride(one.model, "front", roll=False) for one in (car, Car.load("sedan")))
    new, old = (ride.ride_frequency for ride in rides)
    assert new == pytest.approx(old, rel=1e-3)


def test_double_wishbones_replace_the_axle_of_the_template(tmp_path):
    text = "axes: x forward, y left, z up\nname,x [m],y [m],z [m]\n" + "\n".join((
        "lower arm rear,-0.251,0.32,-0.08", "lower arm front,0.148,0.32,-0.094", "lower ball joint,0.013,0.737,-0.145",
        "upper arm rear,-0.105,0.435,0.196", "upper arm front,0.122,0.435,0.23", "upper ball joint,-0.025,0.68,0.162",
        "tie rod inner,-0.15,0.38,-0.038", "tie rod outer,-0.137,0.69,-0.088", "wheel centre,0,0.7575,0",
        "damper upper,-0.02,0.5,0.4", "damper lower,0.0,0.6,-0.11", "", "name,value,unit", "spring rate front,45,N/mm",
    ))  # fmt: skip
    table = read(tmp_path, text)
    assert table.axles == {"front": "double_wishbone"}
    car = new_car("mine", "sedan", stated_numbers(None, {}, table.numbers), table).car
    assert car["front.template"].value == "double_wishbone"
    points = car.vehicle.table["front"]["hardpoints"]
    assert points["upper_ball"] == pytest.approx([0.75 + 0.025, 0.68, 0.705 + 0.162], abs=1e-6)
    # Both ends of the spring are those of the damper, so the rate is one of the spring.
    assert points["spring_lower"] == points["damper_lower"] and car["front.main_spring.stiffness"].value == 45e3


def test_bushings_of_a_table(tmp_path):
    table = read(tmp_path, "bushing,axle,kx [N/mm],ky [N/mm],kz [N/mm],cx [N s/mm],cy [N s/mm],cz [N s/mm]\n"
                 "lower arm rear,front,800,900,500,0.8,0.9,0.5\ntrailing arm pivot,rear,700,1100,700,0.7,1,0.7\n"
                 "tie rod inner,front,1,1,1,1,1,1\n")  # fmt: skip
    assert table.parameters["front", "bushings.arm_rear.stiffness"][0] == [8e5, 9e5, 5e5]
    assert table.parameters["rear", "bushings.pivot.damping"][0] == [700.0, 1000.0, 700.0]
    result = new_car("mine", "sedan", stated_numbers(None, {}, table.numbers), table)
    assert list(result.car["front.bushings.arm_rear.stiffness"].value) == [8e5, 9e5, 5e5]
    own = read(tmp_path, "\n".join(table_lines(result, template_car("sedan"), table)), name="own.csv")
    assert {key: value for key, (value, _) in own.parameters.items()} == {
        key: value for key, (value, _) in table.parameters.items()
    }
    assert sum("tie rod inner" in text for _, text in table.left_out) == 2


def test_typed_numbers_take_precedence_over_those_of_a_table(tmp_path):
    table = read(tmp_path, "name,value,unit\nmass,1400,kg\nfront axle load,800,kg\nwheel rate front,22,N/mm\n")
    stated = stated_numbers(None, {"kerb_mass": 1500.0, "ride_frequency_front": 1.3, "rear_axle_load": 640.0},
                            table.numbers)  # fmt: skip
    assert (stated.kerb_mass, stated.front_axle_load, stated.rear_axle_load) == (1500.0, None, 640.0)
    assert (stated.ride_frequency_front, stated.wheel_rate_front) == (1.3, None)


def test_moments_of_the_sprung_mass_become_those_of_the_car(tmp_path):
    """By hand: wheels of 40 kg at their centres, by the parallel axes about the CoG of the car."""
    table = read(tmp_path, "name,value,unit\nsprung mass,1200,kg\nunsprung mass front axle,80,kg\nunsprung mass rear "
                 "axle,80,kg\nsprung mass cg behind front axle,1.2,m\nsprung mass cg height,0.6,m\nwheelbase,2.6,m\n"
                 "track,1.5,m\ntyre radius,0.3,m\nsprung mass pitch inertia,1800,kg m2\n")  # fmt: skip
    x, h = (1200 * 1.2 + 80 * 2.6) / 1360, (1200 * 0.6 + 160 * 0.3) / 1360
    assert (table.numbers["cog_x"], table.numbers["cog_height"]) == pytest.approx((x, h), abs=1e-6)
    moment = 1800 + 1200 * ((1.2 - x) ** 2 + (0.6 - h) ** 2) + 80 * (x**2 + (2.6 - x) ** 2) + 160 * (h - 0.3) ** 2
    assert table.numbers["pitch_inertia"] == pytest.approx(moment, abs=2e-2)


@pytest.mark.parametrize(
    ("unit", "factor"),
    [("N/mm", 1e3), ("lbf/in", 4.4482216152605 / 0.0254), ("kg m^2", 1.0), ("slug-ft2", 1.3558179483314003),
     ("N·s/m", 1.0), ("N/(m/s)", 1.0), ("Nm/deg", 180.0 / math.pi), ("kNs/m", 1e3), ("°", math.pi / 180.0)],
)  # fmt: skip
def test_units_are_products_of_powers(unit, factor):
    found = unit_factor(unit)
    assert found is not None
    assert found.factor == pytest.approx(factor, rel=1e-12)


WHEEL = "wheel centre,0,750,300\n"
BAD = {
    "two points of one name": ("name,x,y,z\n" + WHEEL + "wheel centre,10,752,300\n", "same point of one side"),
    "left-handed, stated": ("axes: x forward, y right, z up\nname,x,y,z\n" + rows(WORDS["plain"], (-1, 1, 1)),
                            "left-handed"),
    "left-handed, by the sides": ("name,x [m],y [m],z [m]\n" + rows(WORDS["optimum"], (-1, 1, 1), side=-1.0, unit=1.0),
                                  "left-handed"),
    "remark against points": ("axes: x rearward, y right, z up\nname,x,y,z\n" + rows(WORDS["plain"], (-1, -1, 1)),
                              "states x rearward, but its points show x forward"),
    "no direction of x": ("name,x,y,z\n" + WHEEL + "strut top,10,570,800\nlower ball joint,0,700,180\n",
                          "no direction of x"),
    "points without a unit": ("name,x,y,z\nwheel centre,0,29.5,12\nstrut top,1,22,34\n", "no half track in m or mm"),
    "no length": ("name,x [kg],y [kg],z [kg]\n" + WHEEL, "is no length"),
    "no wheel centre": ("axes: adams\nname,x,y,z\nstrut top,10,570,800\nlower ball joint,0,700,180\n", "wheel centre"),
    "across the car": ("axes: adams\nname,x,y,z\n" + WHEEL + "strut top,10,-570,800\n", "across the middle"),
    "missing coordinate": ("name,x,y,z\nwheel centre,0,,300\n", "no three coordinates"),
    "two coordinates": ("front wheel centre x,0\nfront wheel centre y,750\n", "lacks z"),
    "which axle": ("name,x,y,z\nfront wheel centre,0,750,300\nrear wheel centre,2600,750,300\nlca front,1,2,3\n",
                   "names no axle"),
    "axle or place": ("name,x,y,z\nlca rear front,0,400,200\n", "two places, one of which is the axle"),
    "no size": ("name,value\nwheelbase,26.5\n", "has no unit"),
    "wrong unit": ("name,value,unit\nwheelbase,2.6,kg\n", "needs one such as m or mm"),
    "impossible": ("name,value,unit\nwheelbase,2600,m\n", "2600 m, must be 1 to 4.2 m"),
    "twice": ("name,value,unit\nmass,1400,kg\ncurb weight,1500,kg\n", "two values of kerb mass"),
    "wheel or axle": ("name,value,unit\nunsprung mass front,64,kg\n", "of a wheel or of an axle"),
    "thousand or decimal": ("name;value;unit\nmass;1,450;kg\n", "thousand or a decimal"),
    "loads against mass": ("front axle load,800,kg\nrear axle load,800,kg\nmass,1400,kg\n", "together 1600 kg"),
    "masses against mass": ("mass,1400,kg\nsprung mass,1300,kg\nunsprung mass front axle,90,kg\n"
                            "unsprung mass rear axle,90,kg\n", "together 1480 kg"),
    "wheelbase": ("a,1.2,m\nb,1.4,m\nwheelbase,2.7,m\n", "make 2.6 m instead of the wheelbase of 2.7 m"),
    "track against points": ("axes: adams\ntrack front,1600,mm\n\nname,x,y,z\n" + WHEEL + "strut top,10,570,800\n",
                             "the points give 1.5000 m"),
    "ride rate alone": ("ride rate front,20,N/mm\n", "needs the tyre stiffness"),
    "motion ratio of the wheel": ("spring rate front,20,N/mm\nmotion ratio front,1.6,-\n", "must be 0.2 to 1.2"),
    "negative": ("wheel rate front,-20,N/mm\n", "must be 3000"),
    "damper without an axle": ("velocity [m/s],force [N]\n-1,-900\n1,900\n", "of no axle"),
    "damper without units": ("damper front\nvelocity,force\n-1,-900\n1,900\n", "with the unit 'nothing'"),
    "nothing known": ("name,value\ndoors,5\n", "nothing in it is a number or a point of a car"),
    "no number": ("name,value\nwheelbase,long\n", "no cell with a number"),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_a_table_that_is_ambiguous_or_wrong_is_refused(case, tmp_path):
    text, message = BAD[case]
    with pytest.raises(VehicleError, match=message) as error:
        read(tmp_path, text, name="table.csv")
    # One sentence with its remedy.
    assert "\n" not in str(error.value) and (";" in str(error.value) or "correct" in str(error.value))


def test_the_command_prints_what_was_understood_guessed_and_left_out_and_writes_a_picture(tmp_path, capsys):
    file = tmp_path / "mine.csv"
    text = "name,x,y,z\n" + rows(WORDS["plain"]) + "\nname,value,unit\nmass,1500,kg\ndoors,5,-\n"
    file.write_text(text)
    assert main([str(tmp_path / "car"), "--from", "sedan", "--table", str(file)]) == 0
    out = capsys.readouterr().out
    for words in ("lower control arm front", "in mm|without a unit: mm", "'doors' = 5", "guessed:", "left out:"):
        assert any(word in out for word in words.split("|")), words
    assert (tmp_path / "car" / "points.svg").read_text().count("lower_ball") >= 3
    Car.load(tmp_path / "car")


def test_a_file_that_is_no_vehicle_file_is_answered_with_the_files_that_can_be_read(tmp_path):
    (tmp_path / "car.adm").write_text("x")
    with pytest.raises(VehicleError, match=r"--table FILE"):
        Car.load(tmp_path / "car.adm")
