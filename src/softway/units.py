"""Physical quantities as annotated floats. The annotation names the SI unit of a number without unit."""

from typing import Annotated

Metre = Annotated[float, "m"]
SquareMetre = Annotated[float, "m^2"]
Second = Annotated[float, "s"]
Pascal = Annotated[float, "Pa"]
KilogramPerCubicMetre = Annotated[float, "kg/m^3"]
MetrePerSecond = Annotated[float, "m/s"]
MetrePerSecondSquared = Annotated[float, "m/s^2"]
RadianPerSecond = Annotated[float, "rad/s"]
Pure = Annotated[float, ""]
PerSecond = Annotated[float, "1/s"]
PascalSecond = Annotated[float, "Pa s"]
Kelvin = Annotated[float, "K"]
Kilogram = Annotated[float, "kg"]
KilogramSquareMetre = Annotated[float, "kg m^2"]
NewtonPerMetre = Annotated[float, "N/m"]
NewtonSecondPerMetre = Annotated[float, "N s/m"]
NewtonMetre = Annotated[float, "N m"]
