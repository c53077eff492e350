// SPDX-License-Identifier: Apache-2.0
//
// The kernels of all devices, in the words that GLSL, CUDA and C++ have in common: the one source of
// their arithmetic.  Programs of OpenGL are compiled from this text; CUDA and C++ include it as the
// body of DeviceKernels.  Whoever takes it defines before
//   PLACE                a type for positions in arrays
//   ARRAY                (binding, block, type, name): declares an array that is written
//   READ_ARRAY           (binding, block, type, name): declares an array that is read alone
//   PARAMETER            (type, name): declares what kernelParameters.inl lists
//   FUNCTION             what stands before a function
//   REFERENCE(type)      the type of an argument that the function changes, or that is large
//   PRECISE              what keeps a compiler from other sums
//   LENGTH               floats of an element
//   SIZE                 vertices of the faces, for makeFVerticesOfRun and makeLatticeLimit
//
// Kernels are functions of the number of an invocation, called where that is less than count.  Sums
// are in the order of RefinementEvaluator's wherever most vertices are; products and sums are rounded
// one by one, so that the same arrays give the same bits on every device.

READ_ARRAY(0, Sources, float, sources)
ARRAY(1, Results, float, results)
READ_ARRAY(2, Indices, uint, indices)
READ_ARRAY(3, Weights, float, weights)
ARRAY(4, DuResults, float, duResults)
ARRAY(5, DvResults, float, dvResults)
READ_ARRAY(6, ListedVertices, uint, listedVertices)
ARRAY(7, Triangles, uint, triangles)

struct Element {
    float x[LENGTH];
};

FUNCTION float add(float a, float b) {
    PRECISE float sum = a + b;
    return sum;
}
FUNCTION float multiply(float a, float b) {
    PRECISE float product = a * b;
    return product;
}
FUNCTION float addProduct(float sum, float a, float b) { return add(sum, multiply(a, b)); }

FUNCTION Element getZero() {
    Element e;
    for (int k = 0; k < LENGTH; ++k) {
        e.x[k] = 0.0f;
    }
    return e;
}
FUNCTION Element addElements(Element a, Element b) {
    for (int k = 0; k < LENGTH; ++k) {
        a.x[k] = add(a.x[k], b.x[k]);
    }
    return a;
}
FUNCTION Element scaleElement(float weight, Element e) {
    for (int k = 0; k < LENGTH; ++k) {
        e.x[k] = multiply(weight, e.x[k]);
    }
    return e;
}
FUNCTION void addTo(REFERENCE(Element) sum, float weight, Element e) {
    for (int k = 0; k < LENGTH; ++k) {
        sum.x[k] = addProduct(sum.x[k], weight, e.x[k]);
    }
}

FUNCTION Element getSource(uint i) {
    Element e;
    PLACE place = sourceOffset + PLACE(i) * sourceStride;
    for (int k = 0; k < LENGTH; ++k) {
        e.x[k] = sources[place + PLACE(k)];
    }
    return e;
}
FUNCTION Element getFVertex(uint corner) {
    Element e;
    PLACE place = resultOffset + PLACE(firstFVertex + corner) * resultStride;
    for (int k = 0; k < LENGTH; ++k) {
        e.x[k] = results[place + PLACE(k)];
    }
    return e;
}
FUNCTION void store(uint i, Element e) {
    PLACE place = resultOffset + PLACE(i) * resultStride;
    for (int k = 0; k < LENGTH; ++k) {
        results[place + PLACE(k)] = e.x[k];
    }
}

FUNCTION uint getVertexOfCorner(uint corner) {
    return corner < numConsecutiveCorners
               ? firstConsecutiveVertex + corner
               : listedVertices[firstListedVertex + PLACE(corner - numConsecutiveCorners)];
}

// Elements one behind the other, those of the control values or of what the indices list.
FUNCTION void copyElement(uint i) {
    store(i, getSource(hasIndices != 0u ? indices[firstIndex + PLACE(i)] : i));
}

// A plain face of 3 to 6 sides: P = weightOfSelf V + weightOfNeighbors (V before + V behind) +
// weightOfOpposite V across + weightOfAll (sum of V).
FUNCTION void makeFVerticesOfRun(uint i) {
    uint corner = firstCorner + i * uint(SIZE);
    Element v[SIZE];
    for (int j = 0; j < SIZE; ++j) {
        v[j] = getSource(getVertexOfCorner(corner + uint(j)));
    }
    Element sum = v[0];
    for (int j = 1; j < SIZE; ++j) {
        sum = addElements(sum, v[j]);
    }
    sum = scaleElement(weightOfAll, sum);
    for (int j = 0; j < SIZE; ++j) {
        Element e = sum;
        addTo(e, weightOfSelf, v[j]);
        if (SIZE > 3) {
            addTo(e, weightOfNeighbors, addElements(v[(j + SIZE - 1) % SIZE], v[(j + 1) % SIZE]));
        }
        if (SIZE == 6 && weightOfOpposite != 0.0f) {
            addTo(e, weightOfOpposite, v[(j + SIZE / 2) % SIZE]);
        }
        store(firstFVertex + corner + uint(j), e);
    }
}

// A plain face of any size.
FUNCTION void makeFVerticesOfFace(uint i) {
    uint corner = firstCorner + i * faceSize;
    Element sum = getSource(getVertexOfCorner(corner));
    for (uint j = 1u; j < faceSize; ++j) {
        sum = addElements(sum, getSource(getVertexOfCorner(corner + j)));
    }
    sum = scaleElement(weightOfAll, sum);
    for (uint j = 0u; j < faceSize; ++j) {
        uint before = j == 0u ? faceSize - 1u : j - 1u;
        uint behind = j + 1u == faceSize ? 0u : j + 1u;
        Element e = sum;
        addTo(e, weightOfSelf, getSource(getVertexOfCorner(corner + j)));
        addTo(e, weightOfNeighbors,
              addElements(getSource(getVertexOfCorner(corner + before)),
                          getSource(getVertexOfCorner(corner + behind))));
        store(firstFVertex + corner + j, e);
    }
}

// A plain face whose weights are all different: those of corner 0 stand twice in a row.
FUNCTION void makeFVerticesByWeights(uint i) {
    uint corner = firstCorner + i * faceSize;
    for (uint c = 0u; c < faceSize; ++c) {
        Element e = getZero();
        for (uint j = 0u; j < faceSize; ++j) {
            addTo(e, weights[firstWeight + PLACE(faceSize - c + j)],
                  getSource(getVertexOfCorner(corner + j)));
        }
        store(firstFVertex + corner + c, e);
    }
}

// A DeviceCorner.
FUNCTION void makeListedFVertex(uint i) {
    PLACE place = firstIndex + PLACE(4) * PLACE(i);
    uint size = indices[place + PLACE(1)];
    PLACE vert = PLACE(indices[place + PLACE(2)]);
    PLACE first = PLACE(indices[place + PLACE(3)]);
    Element e = getZero();
    for (uint j = 0u; j < size; ++j) {
        float weight = weights[first + PLACE(j)];
        if (weight != 0.0f) {
            addTo(e, weight, getSource(indices[vert + PLACE(j)]));
        }
    }
    store(firstFVertex + indices[place], e);
}

// A vertex with three faces.
FUNCTION void makeVVertexOfRun(uint i) {
    Element e = getSource(firstVertex + i);
    if (averagesFaces != 0u) {
        PLACE place = firstIndex + PLACE(3) * PLACE(i);
        Element a = getFVertex(indices[place]);
        Element b = getFVertex(indices[place + PLACE(1)]);
        Element c = getFVertex(indices[place + PLACE(2)]);
        if (addsInTurn != 0u) {
            e = addElements(addElements(addElements(e, a), b), c);
        } else {
            e = addElements(e, addElements(a, addElements(b, c)));
        }
        e = scaleElement(vertexWeight, e);
    }
    store(firstVertex + i, e);
}

// A DeviceVertex.
FUNCTION void makeListedVVertex(uint i) {
    PLACE place = firstIndex + PLACE(5) * PLACE(i);
    uint child = indices[place];
    uint numSources = indices[place + PLACE(1)];
    uint numCorners = indices[place + PLACE(2)];
    bool eachHasAWeight = numCorners >= 0x80000000u;
    numCorners = numCorners & 0x7fffffffu;
    PLACE next = PLACE(indices[place + PLACE(3)]);
    PLACE first = PLACE(indices[place + PLACE(4)]);
    Element e = getZero();
    for (uint j = 0u; j < numSources; ++j) {
        addTo(e, weights[first + PLACE(j)], getSource(indices[next + PLACE(j)]));
    }
    if (numSources == 0u) {
        e = getSource(child);
        for (uint j = 0u; j < numCorners; ++j) {
            e = addElements(e, getFVertex(indices[next + PLACE(j)]));
        }
        e = scaleElement(weights[first], e);
    } else if (eachHasAWeight) {
        next = next + PLACE(numSources);
        first = first + PLACE(numSources);
        // From the last one on, as on the processor.
        Element sum = getZero();
        for (uint j = numCorners; j > 0u; --j) {
            addTo(sum, weights[first + PLACE(j - 1u)], getFVertex(indices[next + PLACE(j - 1u)]));
        }
        e = addElements(e, sum);
    } else if (numCorners > 0u) {
        next = next + PLACE(numSources);
        Element sum = getFVertex(indices[next]);
        for (uint j = 1u; j < numCorners; ++j) {
            sum = addElements(sum, getFVertex(indices[next + PLACE(j)]));
        }
        addTo(e, weights[first + PLACE(numSources)], sum);
    }
    store(child, e);
}

FUNCTION void storeTriangle(PLACE place, uint a, uint b, uint c) {
    triangles[place] = uint(vertexOffset) + getVertexOfCorner(a);
    triangles[place + PLACE(1)] = uint(vertexOffset) + getVertexOfCorner(b);
    triangles[place + PLACE(2)] = uint(vertexOffset) + getVertexOfCorner(c);
}

// The triangles of a face, which zigzag across it as those of CreateTriangleIndices.  Faces before have
// two triangles fewer than corners, each.
FUNCTION void makeTriangles(uint i) {
    uint corner = firstCorner + i * faceSize;
    uint size = faceSize;
    if (hasIndices != 0u) {
        corner = indices[firstIndex + PLACE(i)];
        size = indices[firstIndex + PLACE(i + 1u)] - corner;
    }
    PLACE place = resultOffset + PLACE(3) * PLACE(corner - 2u * (firstFace + i));
    uint low = corner;
    uint high = corner + size - 1u;
    while (high - low >= 2u) {
        storeTriangle(place, low, low + 1u, high);
        place = place + PLACE(3);
        low = low + 1u;
        if (high - low >= 2u) {
            storeTriangle(place, low, high - 1u, high);
            place = place + PLACE(3);
            high = high - 1u;
        }
    }
}
