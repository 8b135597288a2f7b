"""The bed in a state as a table for `packing.rs`: python table.py RUN/state.h5 > bed.csv

Prints the height of the top wall to standard error.
"""

import sys

import netCDF4

state = netCDF4.Dataset(sys.argv[1])
print(f"height: {-state['walls/offset'][1]:.17g} m", file=sys.stderr)
size, position = state["box/size"][:], state["grains/position"][:].data
position[:, :2] %= size
print("x,y,z,radius")
for row, radius in zip(position, state["grains/radius"][:]):
    print(",".join(f"{value:.17g}" for value in (*row, radius)))
