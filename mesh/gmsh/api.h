/* The functions of gmsh that are used, from its library as soon as one of them is called. The
 * library and the 72 others that it brings take 45 MB and 0.15 s, which most runs save. */
#ifndef MESH_GMSH_API_H
#define MESH_GMSH_API_H

#include <gmshc.h>

#include "mesh/base/status.h"

/* clang-format off */
#define MESH_GMSH_FUNCTIONS(F) \
  F(Finalize) \
  F(Free) \
  F(Initialize) \
  F(LoggerGet) \
  F(LoggerGetLastError) \
  F(LoggerStart) \
  F(LoggerStop) \
  F(Merge) \
  F(ModelAdd) \
  F(ModelAddDiscreteEntity) \
  F(ModelAddPhysicalGroup) \
  F(ModelGeoAddCurveLoop) \
  F(ModelGeoAddLine) \
  F(ModelGeoAddPlaneSurface) \
  F(ModelGeoAddPoint) \
  F(ModelGeoMeshSetTransfiniteCurve) \
  F(ModelGeoSynchronize) \
  F(ModelGetBoundary) \
  F(ModelGetBoundingBox) \
  F(ModelGetClosestPoint) \
  F(ModelGetCurrent) \
  F(ModelGetDerivative) \
  F(ModelGetEntities) \
  F(ModelGetEntitiesForPhysicalGroup) \
  F(ModelGetParametrizationBounds) \
  F(ModelGetPhysicalGroups) \
  F(ModelGetPhysicalName) \
  F(ModelGetType) \
  F(ModelGetValue) \
  F(ModelMeshAddElementsByType) \
  F(ModelMeshAddNodes) \
  F(ModelMeshClear) \
  F(ModelMeshGenerate) \
  F(ModelMeshGetElementTypes) \
  F(ModelMeshGetElementsByType) \
  F(ModelMeshGetNodes) \
  F(ModelMeshGetNodesByElementType) \
  F(ModelMeshRemoveSizeCallback) \
  F(ModelMeshSetNode) \
  F(ModelMeshSetOrder) \
  F(ModelMeshSetPeriodic) \
  F(ModelMeshSetRecombine) \
  F(ModelMeshSetSizeCallback) \
  F(ModelOccAddBox) \
  F(ModelOccAddCurveLoop) \
  F(ModelOccAddLine) \
  F(ModelOccAddPlaneSurface) \
  F(ModelOccAddPoint) \
  F(ModelOccAddSpline) \
  F(ModelOccAddThruSections) \
  F(ModelOccFuse) \
  F(ModelOccGetCenterOfMass) \
  F(ModelOccGetMass) \
  F(ModelOccImportShapes) \
  F(ModelOccRemoveAllDuplicates) \
  F(ModelOccRevolve) \
  F(ModelOccSynchronize) \
  F(ModelRemove) \
  F(ModelRemoveEntities) \
  F(ModelSetCurrent) \
  F(ModelSetPhysicalName) \
  F(Open) \
  F(OptionGetNumber) \
  F(OptionSetNumber) \
  F(Write)
/* clang-format on */

typedef struct {
#define MESH_GMSH_MEMBER(name) __typeof__(gmsh##name) *name;
  MESH_GMSH_FUNCTIONS(MESH_GMSH_MEMBER)
#undef MESH_GMSH_MEMBER
} mesh_gmsh_functions;

/* Load the library if it is not there yet. SHB_ERR_IO: it cannot be loaded. */
shb_status mesh_gmsh_load(void);

/* The functions; mesh_session_open has loaded them. */
const mesh_gmsh_functions *mesh_gmsh(void);

#define gmshFinalize (mesh_gmsh()->Finalize)
#define gmshFree (mesh_gmsh()->Free)
#define gmshInitialize (mesh_gmsh()->Initialize)
#define gmshLoggerGet (mesh_gmsh()->LoggerGet)
#define gmshLoggerGetLastError (mesh_gmsh()->LoggerGetLastError)
#define gmshLoggerStart (mesh_gmsh()->LoggerStart)
#define gmshLoggerStop (mesh_gmsh()->LoggerStop)
#define gmshMerge (mesh_gmsh()->Merge)
#define gmshModelAdd (mesh_gmsh()->ModelAdd)
#define gmshModelAddDiscreteEntity (mesh_gmsh()->ModelAddDiscreteEntity)
#define gmshModelAddPhysicalGroup (mesh_gmsh()->ModelAddPhysicalGroup)
#define gmshModelGeoAddCurveLoop (mesh_gmsh()->ModelGeoAddCurveLoop)
#define gmshModelGeoAddLine (mesh_gmsh()->ModelGeoAddLine)
#define gmshModelGeoAddPlaneSurface (mesh_gmsh()->ModelGeoAddPlaneSurface)
#define gmshModelGeoAddPoint (mesh_gmsh()->ModelGeoAddPoint)
#define gmshModelGeoMeshSetTransfiniteCurve (mesh_gmsh()->ModelGeoMeshSetTransfiniteCurve)
#define gmshModelGeoSynchronize (mesh_gmsh()->ModelGeoSynchronize)
#define gmshModelGetBoundary (mesh_gmsh()->ModelGetBoundary)
#define gmshModelGetBoundingBox (mesh_gmsh()->ModelGetBoundingBox)
#define gmshModelGetClosestPoint (mesh_gmsh()->ModelGetClosestPoint)
#define gmshModelGetCurrent (mesh_gmsh()->ModelGetCurrent)
#define gmshModelGetDerivative (mesh_gmsh()->ModelGetDerivative)
#define gmshModelGetEntities (mesh_gmsh()->ModelGetEntities)
#define gmshModelGetEntitiesForPhysicalGroup (mesh_gmsh()->ModelGetEntitiesForPhysicalGroup)
#define gmshModelGetParametrizationBounds (mesh_gmsh()->ModelGetParametrizationBounds)
#define gmshModelGetPhysicalGroups (mesh_gmsh()->ModelGetPhysicalGroups)
#define gmshModelGetPhysicalName (mesh_gmsh()->ModelGetPhysicalName)
#define gmshModelGetType (mesh_gmsh()->ModelGetType)
#define gmshModelGetValue (mesh_gmsh()->ModelGetValue)
#define gmshModelMeshAddElementsByType (mesh_gmsh()->ModelMeshAddElementsByType)
#define gmshModelMeshAddNodes (mesh_gmsh()->ModelMeshAddNodes)
#define gmshModelMeshClear (mesh_gmsh()->ModelMeshClear)
#define gmshModelMeshGenerate (mesh_gmsh()->ModelMeshGenerate)
#define gmshModelMeshGetElementTypes (mesh_gmsh()->ModelMeshGetElementTypes)
#define gmshModelMeshGetElementsByType (mesh_gmsh()->ModelMeshGetElementsByType)
#define gmshModelMeshGetNodes (mesh_gmsh()->ModelMeshGetNodes)
#define gmshModelMeshGetNodesByElementType (mesh_gmsh()->ModelMeshGetNodesByElementType)
#define gmshModelMeshRemoveSizeCallback (mesh_gmsh()->ModelMeshRemoveSizeCallback)
#define gmshModelMeshSetNode (mesh_gmsh()->ModelMeshSetNode)
#define gmshModelMeshSetOrder (mesh_gmsh()->ModelMeshSetOrder)
#define gmshModelMeshSetPeriodic (mesh_gmsh()->ModelMeshSetPeriodic)
#define gmshModelMeshSetRecombine (mesh_gmsh()->ModelMeshSetRecombine)
#define gmshModelMeshSetSizeCallback (mesh_gmsh()->ModelMeshSetSizeCallback)
#define gmshModelOccAddBox (mesh_gmsh()->ModelOccAddBox)
#define gmshModelOccAddCurveLoop (mesh_gmsh()->ModelOccAddCurveLoop)
#define gmshModelOccAddLine (mesh_gmsh()->ModelOccAddLine)
#define gmshModelOccAddPlaneSurface (mesh_gmsh()->ModelOccAddPlaneSurface)
#define gmshModelOccAddPoint (mesh_gmsh()->ModelOccAddPoint)
#define gmshModelOccAddSpline (mesh_gmsh()->ModelOccAddSpline)
#define gmshModelOccAddThruSections (mesh_gmsh()->ModelOccAddThruSections)
#define gmshModelOccFuse (mesh_gmsh()->ModelOccFuse)
#define gmshModelOccGetCenterOfMass (mesh_gmsh()->ModelOccGetCenterOfMass)
#define gmshModelOccGetMass (mesh_gmsh()->ModelOccGetMass)
#define gmshModelOccImportShapes (mesh_gmsh()->ModelOccImportShapes)
#define gmshModelOccRemoveAllDuplicates (mesh_gmsh()->ModelOccRemoveAllDuplicates)
#define gmshModelOccRevolve (mesh_gmsh()->ModelOccRevolve)
#define gmshModelOccSynchronize (mesh_gmsh()->ModelOccSynchronize)
#define gmshModelRemove (mesh_gmsh()->ModelRemove)
#define gmshModelRemoveEntities (mesh_gmsh()->ModelRemoveEntities)
#define gmshModelSetCurrent (mesh_gmsh()->ModelSetCurrent)
#define gmshModelSetPhysicalName (mesh_gmsh()->ModelSetPhysicalName)
#define gmshOpen (mesh_gmsh()->Open)
#define gmshOptionGetNumber (mesh_gmsh()->OptionGetNumber)
#define gmshOptionSetNumber (mesh_gmsh()->OptionSetNumber)
#define gmshWrite (mesh_gmsh()->Write)

#endif
