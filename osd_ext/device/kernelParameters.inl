// SPDX-License-Identifier: Apache-2.0
//
// Parameters of kernels besides their arrays: PARAMETER(type, name), or PARAMETER_ARRAY(type, name,
// size).  See kernels.inl.

PARAMETER(uint, count) // of invocations

// Floats of the arrays: where element 0 begins, and from one to the next.
PARAMETER(PLACE, sourceOffset)
PARAMETER(PLACE, sourceStride)
PARAMETER(PLACE, resultOffset)
PARAMETER(PLACE, resultStride)
PARAMETER(PLACE, duOffset)
PARAMETER(PLACE, duStride)
PARAMETER(PLACE, dvOffset)
PARAMETER(PLACE, dvStride)

PARAMETER(uint, firstFVertex) // element of the results, behind the V-vertices

// The vertices of the corners of the parent's faces: those of its F-faces follow one another, the
// others are listed.
PARAMETER(uint, numConsecutiveCorners)
PARAMETER(uint, firstConsecutiveVertex)
PARAMETER(PLACE, firstListedVertex) // position in listedVertices

PARAMETER(PLACE, firstIndex)  // position in indices of what a kernel lists
PARAMETER(PLACE, firstWeight) // position in weights
PARAMETER(uint, firstCorner)  // of a run of faces
PARAMETER(uint, firstFace)    // of one that is cut into triangles
PARAMETER(uint, vertexOffset) // added to the vertices of triangles
PARAMETER(uint, faceSize)     // of its faces
PARAMETER(uint, firstVertex)  // of a run of vertices
PARAMETER(float, vertexWeight)
// For plain faces.
PARAMETER(float, weightOfAll)
PARAMETER(float, weightOfSelf)
PARAMETER(float, weightOfNeighbors)
PARAMETER(float, weightOfOpposite)
// Elements that are copied are listed, and the first corners of faces; else they follow one another.
PARAMETER(uint, hasIndices)
PARAMETER(uint, averagesFaces) // else V-vertices stay
PARAMETER(uint, addsInTurn)    // the three F-vertices of a vertex; else the last two first
PARAMETER(uint, hasDerivatives)

PARAMETER_ARRAY(float, regularWeights, 54) // RegularLimitWeights, in their order

// Lattice faces, and how many floats of the elements are made: an invocation makes one of a face.
PARAMETER(uint, numFaces)
PARAMETER(uint, numFloats)
// Their orbits that are made together, and how many of them, the first ones, are pairs.
PARAMETER(uint, numOrbits)
PARAMETER(uint, numPairs)
PARAMETER(PLACE, firstOutput)               // position in indices of the first orbit's vertices
PARAMETER_ARRAY(float, latticeWeights, 520) // of up to 4 orbits
