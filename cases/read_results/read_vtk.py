#!/usr/bin/env python3
"""Reads the modes of NAME.modal.h5 with VTK and writes NAME.mode_1.vtu: read_vtk.py FOLDER/NAME

Needs VTK 9.1 or later (python3-vtk9). VTK picks its reader by what the file holds, not by its name.
"""
import sys

from vtkmodules.vtkFiltersGeneral import vtkWarpVector
from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

name = sys.argv[1]
reader = vtkHDFReader()
reader.SetFileName(name + '.modal.h5')
reader.Update()
grid = reader.GetOutput()
data = grid.GetPointData()
arrays = [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]
print(grid.GetNumberOfPoints(), 'nodes,', grid.GetNumberOfCells(), 'elements:', sorted(arrays))

first = min(word for word in arrays if word.startswith('mode_'))  # "mode_001 116.684 Hz"
data.SetActiveVectors(first)
warp = vtkWarpVector()
warp.SetInputData(grid)
warp.SetScaleFactor(0.02)
writer = vtkXMLUnstructuredGridWriter()
writer.SetFileName(name + '.mode_1.vtu')
writer.SetInputConnection(warp.GetOutputPort())
writer.Write()
