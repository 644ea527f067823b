"""Small files of loggers, as their programs write them, for the tests of the readers and the mutations of `fuzz`."""

import math

RACECHRONO = """This file is created using RaceChrono Pro v9.1.3 ( http://racechrono.com/ ).
Format,3
Session title,"53, Bannings Way"

Created,09/02/2026,19:19
Note,

timestamp,lap_number,elapsed_time,speed,lateral_acc,speed
unix time,,s,m/s,G,m/s
,,,100: gps,calc,200: canbus
1770664802.05,,0.05,10.5,0.25,10.25
1770664802.1,,0.1,10.75,,10.5
1770664802.15,,0.15,11.0,0.75,10.75
1770664802.2,,0.2,11.25,1.0,11.0
1770664802.25,,0.25,11.5,1.25,11.25
"""

SHIMMER = '"sep=\t"\n' + "\n".join(
    [
        "Shimmer_9DD4_Timestamp_Unix_CAL\tShimmer_9DD4_Accel_LN_X_CAL\tShimmer_9DD4_Gyro_Z_CAL\t",
        "ms\tm/(s^2)\tdeg/s\t",
        *(f"{1.584614540601e12 + 2.0 * n!r}\t{0.1 * n:.3f}\t{n - 3.0}\t" for n in range(8)),
    ]
)

SHIMMER_OLD = "\n".join(
    [
        "Shimmer\tShimmer\tShimmer",
        "Timestamp\tAccelerometer X\tAccelerometer Y",
        "CAL\tCAL\tCAL",
        "mSecs\tm/(sec^2)\tm/(sec^2)",
        *(f"{20.0 * n}\t{0.5 * n}\t{-0.5 * n}" for n in range(8)),
    ]
)

MOTEC = "\n".join(
    [
        '"Format","MoTeC CSV File",,"Workbook",""',
        '"Venue","Ring, north",,"Worksheet",""',
        '"Sample Rate","50.000","Hz",,',
        "",
        '"Time","Damper Pos FL","G Force Vert","Engine RPM"',
        '"s","mm","G","rpm"',
        "",
        *(f'"{n / 50:.3f}","{n:.2f}","{0.01 * n:.3f}","{3000 + n}"' for n in range(8)),
    ]
)

ANDROSENSOR = "sep=;\n" + "\n".join(
    [
        "ACCELEROMETER X (m/s²);ACCELEROMETER Z (m/s²);LIGHT (lux);Time since start in ms ;YYYY-MO-DD HH-MI-SS_SSS",
        *(f"{0.1 * n:.4f};{9.81 + 0.1 * n:.4f};{n}.0;{5 * n};2014-05-13 14:08:14:{600 + 5 * n}" for n in range(8)),
    ]
)

TORQUE = "\n".join(
    [
        "GPS Time, Device Time, Longitude,Acceleration Sensor(Total)(g),Speed (OBD)(km/h),Mass Air Flow Rate(g/s)",
        *(
            f"Tue Aug 21 18:21:1{n} MESZ 2012,21-Aug-2012 18:20:2{n}.500,6.96418,{0.1 * n:.2f},{30 + n},16.5"
            for n in range(8)
        ),
    ]
)

LVM = "\n".join([
    "LabVIEW Measurement\t", "Writer_Version\t2", "Separator\tTab", "Decimal_Separator\t,", "Multi_Headings\tYes",
    "X_Columns\tNo", "***End_of_Header***\t", "\t", "Channels\t2\t\t", "Samples\t6\t6\t",
    "Date\t2013/02/19\t2013/02/19\t", "Time\t09:51:40,5\t09:51:40,5\t", "Y_Unit_Label\tNewtons\tm/s^2\t",
    "X_Dimension\tTime\tTime\t", "X0\t0,0000000000000000E+0\t0,0000000000000000E+0\t",
    "Delta_X\t3,906250E-5\t3,906250E-5\t", "***End_of_Header***\t\t\t", "X_Value\tExcitation\tResponse\tComment",
    *(f"\t{0.5 * n:.6f}\t{1.0 + n:.6f}{'' if n else chr(9) + 'start'}".replace(".", ",") for n in range(6)), "",
])  # fmt: skip


def lvm_segments(second_time: str, layout: str = "One") -> str:
    """An LVM file of two segments of four samples at 100 Hz whose clocks begin at 10:00:00 and at another time."""
    parts = ["LabVIEW Measurement\t", f"Separator\tTab\nDecimal_Separator\t.\nMulti_Headings\tYes\nX_Columns\t{layout}",
             "***End_of_Header***\t"]  # fmt: skip
    for number, clock in enumerate(("10:00:00.0", second_time)):
        parts += ["", "Channels\t1\t", "Samples\t4\t", "Date\t2026/01/02\t", f"Time\t{clock}\t", "Y_Unit_Label\tg\t"]
        parts += ["X_Dimension\tTime\t", "X0\t0.0E+0\t", "Delta_X\t0.010000\t", "***End_of_Header***\t\t"]
        parts += ["X_Value\tacc\tComment"]
        parts += [f"{0.01 * n if layout == 'One' else ''}\t{10 * number + n}.5" for n in range(4)]
    return "\n".join(parts) + "\n"


VBO = "\n".join([
    "File created on 31/07/2006 at 09:55:20", "", "[header]", "satellites", "time", "latitude", "longitude",
    "velocity kmh", "heading", "height", "long accel g", "Yaw_Rate", "", "[channel units]", "g", "deg/s", "",
    "[comments]", "VBox II Version 4.5a", "", "[column names]",
    "sats time lat long velocity heading height longacc Yaw_Rate", "", "[data]",
    *(
        f"008 {clock} +03119.09973 +00058.49277 {36.0 + n:.3f} 321.85 +00152.58 {0.1 * n:+.4f} {n:+.2f}"
        for n, clock in enumerate(("235959.80", "235959.90", "000000.00", "000000.10", "000000.20"))
    ), "",
])  # fmt: skip

ASC = "\n".join(
    [
        "date Tue May 27 04:09:35.000 pm 2014",
        "base hex  timestamps absolute",
        "internal events logged",
        "   0.010000 1  Statistic: D 0 R 0 XD 0 XR 0 E 0 O 0 B 0.00%",
        *(f"   {0.02 * n + 0.02:.6f} 1  64              Rx   d 4 {n:02X} 01 00 00" for n in range(6)),
        *(f"   {0.02 * n + 0.025:.6f} 1  18EBFF00x       Rx   d 2 {n:02X} 00" for n in range(6)),
    ]
)

CANDUMP = "\n".join(f"({1436509052.25 + 0.02 * n:.6f}) vcan0 064#{n:02X}010000" for n in range(6))

TRC = ";$FILEVERSION=1.1\n;$STARTTIME=40000.5\n;\n" + "\n".join(
    f"{n + 1:6d})  {20.0 * n:9.1f}  Rx     0064  4  {n:02X} 01 00 00 " for n in range(6)
)

TRC_2 = ";$FILEVERSION=2.1\n;$STARTTIME=43008.92\n;$COLUMNS=N,O,T,B,I,d,R,L,D\n;\n" + "\n".join(
    f"{n + 1:6d}  {20.0 * n:11.3f} DT  1      0064 Rx -  4    {n:02X} 01 00 00 " for n in range(6)
)

DBC = """VERSION ""

NS_ :

BS_:

BU_: ECU

BO_ 100 Body: 4 ECU
 SG_ AccZ : 0|16@1- (0.01,-1) [0|0] "g" ECU
 SG_ Speed : 16|16@1+ (0.1,0) [0|0] "km/h" ECU

"""

CLOCKS = {
    "iso": ("time,acc_z_g", lambda n: f"2026-03-01T10:00:00.{10 * n:03d}Z"),
    "blank": ("when;acc_z_g", lambda n: f"01.03.2026 10:00:00,{10 * n:03d}"),
    "clock": ("Uhr\tacc_z_g", lambda n: f"23:59:59.{960 + 10 * n:03d}" if n < 4 else f"00:00:00.{10 * n - 40:03d}"),
    "two": ("Date,Time,acc_z_g", lambda n: f"02/03/2026,10:00:00.{10 * n:03d}"),
    "half": ("time,acc_z_g", lambda n: f"3/1/2026 12:00:00.{10 * n:03d} PM"),
    "s": ("timestamp,acc_z_g", lambda n: f"{1770664802 + 0.01 * n:.2f}"),
    "ms": ("timestamp,acc_z_g", lambda n: f"{1770664802000 + 10 * n}"),
    "us": ("timestamp_us,acc_z_g", lambda n: f"{1770664802000000 + 10000 * n}"),
    "ns": ("time,acc_z_g", lambda n: f"{1770664802000000000 + 10000000 * n}"),
}
"""Forms of times: head of the file, and the text of the time of row n at 100 Hz."""


def clock_file(form: str, rows: int = 8) -> str:
    """A file of a logger whose times are of a form of `CLOCKS`."""
    head, stamp = CLOCKS[form]
    sign = next(one for one in ";\t," if one in head)
    return head + "\n" + "".join(f"{stamp(n)}{sign}{math.sin(n):.6f}\n" for n in range(rows))


TEXTS = {
    "racechrono.csv": RACECHRONO,
    "shimmer.csv": SHIMMER,
    "shimmer_old.dat": SHIMMER_OLD,
    "motec.csv": MOTEC,
    "androsensor.csv": ANDROSENSOR,
    "torque.csv": TORQUE,
    "one.lvm": LVM,
    "two.lvm": lvm_segments("10:00:05.0"),
    "car.vbo": VBO,
    "bus.asc": ASC,
    "bus.log": CANDUMP,
    "bus.trc": TRC,
    "bus2.trc": TRC_2,
    **{f"{form}.txt": clock_file(form) for form in CLOCKS},
}
"""Name of a file to its text."""
