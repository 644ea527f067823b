"""An FMU of the car, for Simulink, OpenModelica and other masters."""

import zipfile
from xml.etree import ElementTree

from vehicle import Car, write_fmu

# A rolling sedan with all loads as outputs, FMI 2; the plates are its inputs.
car = Car.load("sedan", {"driving.speed": 80 / 3.6})
write_fmu(car, "sedan.fmu", fmi="2")

# What the master sees.
with zipfile.ZipFile("sedan.fmu") as archive:
    model = ElementTree.fromstring(archive.read("modelDescription.xml"))
    size = sum(item.file_size for item in archive.infolist())
variables = list(model.iter("ScalarVariable"))
for kind in ("input", "output", "parameter"):
    names = [each.get("name") for each in variables if each.get("causality") == kind]
    print(f"{len(names):3} {kind}s, for example {', '.join(names[:3])}")
experiment = model.find("DefaultExperiment")
print(f"step {1e3 * float(experiment.get('stepSize')):g} ms, {size / 1e6:.1f} MB unpacked")
