// SPDX-License-Identifier: Apache-2.0
//
// The kernels of limits, behind those of kernels.inl: the arithmetic of limitKernelTemplate.h.

// Numbers of the corners of a regular face.
struct Six {
    float x[6];
};

// Of what a vertex of a regular face has around it, the frequencies: see limitKernelTemplate.h.
struct Waves {
    float mean;
    float cosine1;
    float sine1;
    float cosine2;
    float sine2;
    float alternating;
};

FUNCTION Waves findWavesOfCorners(Six at) {
    float sums[3];
    float differences[3];
    for (int i = 0; i < 3; ++i) {
        sums[i] = add(at.x[i], at.x[i + 3]);
        differences[i] = add(at.x[i], -at.x[i + 3]);
    }
    float sum = add(sums[1], sums[2]);
    float difference = add(differences[1], -differences[2]);
    Waves waves;
    waves.mean = add(sums[0], sum);
    waves.cosine2 = addProduct(sums[0], -0.5f, sum);
    waves.sine2 = add(sums[1], -sums[2]);
    waves.alternating = add(differences[0], -difference);
    waves.cosine1 = addProduct(differences[0], 0.5f, difference);
    waves.sine1 = add(differences[1], differences[2]);
    return waves;
}

FUNCTION Waves findWavesOfEdges(Six behind) {
    float sums[3];
    float differences[3];
    for (int i = 0; i < 3; ++i) {
        sums[i] = add(behind.x[i], behind.x[i + 3]);
        differences[i] = add(behind.x[i], -behind.x[i + 3]);
    }
    float sum = add(sums[0], sums[2]);
    float difference = add(differences[0], differences[2]);
    Waves waves;
    waves.mean = add(sum, sums[1]);
    waves.cosine2 = addProduct(-sums[1], 0.5f, sum);
    waves.sine2 = add(sums[0], -sums[2]);
    waves.alternating = add(difference, -differences[1]);
    waves.cosine1 = add(differences[0], -differences[2]);
    waves.sine1 = addProduct(differences[1], 0.5f, difference);
    return waves;
}

FUNCTION Six addWaves(Waves waves) {
    float rest = addProduct(waves.mean, -0.5f, waves.cosine2);
    float turned = addProduct(-waves.alternating, 0.5f, waves.cosine1);
    float even[3];
    even[0] = add(waves.mean, waves.cosine2);
    even[1] = add(rest, waves.sine2);
    even[2] = add(rest, -waves.sine2);
    float odd[3];
    odd[0] = add(waves.alternating, waves.cosine1);
    odd[1] = add(turned, waves.sine1);
    odd[2] = add(waves.sine1, -turned);
    Six at;
    for (int i = 0; i < 3; ++i) {
        at.x[i] = add(even[i], odd[i]);
        at.x[i + 3] = add(even[i], -odd[i]);
    }
    return at;
}

// RegularLimitWeights, in their order.
struct LimitWeights {
    float x[52];
};

FUNCTION float weigh3(REFERENCE(LimitWeights) w, int first, float ofVertices, float ofNeighbors,
                      float ofPairs) {
    float sum = multiply(w.x[first], ofVertices);
    sum = addProduct(sum, w.x[first + 1], ofNeighbors);
    return addProduct(sum, w.x[first + 2], ofPairs);
}

// By SymmetricWeights, the first of which has a place.
FUNCTION Waves weighSymmetric(REFERENCE(LimitWeights) w, int first, Waves verts, Waves neighbors,
                              Waves pairs) {
    Waves result;
    result.mean = weigh3(w, first, verts.mean, neighbors.mean, pairs.mean);
    result.cosine1 = weigh3(w, first + 3, verts.cosine1, neighbors.cosine1, pairs.cosine1);
    result.sine1 = weigh3(w, first + 6, verts.sine1, neighbors.sine1, pairs.sine1);
    result.cosine2 = weigh3(w, first + 9, verts.cosine2, neighbors.cosine2, pairs.cosine2);
    result.sine2 = weigh3(w, first + 12, verts.sine2, neighbors.sine2, pairs.sine2);
    result.alternating = addProduct(multiply(w.x[first + 15], verts.alternating), w.x[first + 16],
                                    neighbors.alternating);
    return result;
}

// By AntisymmetricWeights, likewise.
FUNCTION Waves weighAntisymmetric(REFERENCE(LimitWeights) w, int first, Waves verts,
                                  Waves neighbors, Waves pairs) {
    Waves result;
    result.mean = 0.0f;
    result.cosine1 = weigh3(w, first, verts.sine1, neighbors.sine1, pairs.sine1);
    result.sine1 = weigh3(w, first + 3, verts.cosine1, neighbors.cosine1, pairs.cosine1);
    result.cosine2 = weigh3(w, first + 6, verts.sine2, neighbors.sine2, pairs.sine2);
    result.sine2 = weigh3(w, first + 9, verts.cosine2, neighbors.cosine2, pairs.cosine2);
    result.alternating = multiply(w.x[first + 12], pairs.alternating);
    return result;
}

FUNCTION float getSourceFloat(uint vert, uint k) {
    return sources[sourceOffset + PLACE(vert) * sourceStride + PLACE(k)];
}

// The F-vertices of a DeviceRegularFace.  What is read once serves all floats of the elements.
FUNCTION void makeRegularLimit(uint i) {
    PLACE place = firstIndex + PLACE(8) * PLACE(i);
    uint corner = indices[place];
    uint locals = indices[place + PLACE(7)];
    LimitWeights w;
    for (int j = 0; j < 52; ++j) {
        w.x[j] = weights[firstWeight + PLACE(j)];
    }
    uint verts[6];
    uint around[36]; // of the faces beyond, from the neighbour on
    for (int j = 0; j < 6; ++j) {
        verts[j] = getVertexOfCorner(corner + uint(j));
        uint beyond = indices[place + PLACE(1 + j)];
        uint local = (locals >> uint(3 * j)) & 7u;
        for (int l = 0; l < 6; ++l) {
            uint turned = local + uint(l);
            around[6 * j + l] = getVertexOfCorner(beyond + (turned < 6u ? turned : turned - 6u));
        }
    }
    for (int k = 0; k < LENGTH; ++k) {
        Six ofVertices;
        Six neighbors;
        Six next;
        Six previous;
        Six tips;
        for (int j = 0; j < 6; ++j) {
            ofVertices.x[j] = getSourceFloat(verts[j], uint(k));
            float x[6];
            for (int l = 0; l < 6; ++l) {
                x[l] = getSourceFloat(around[6 * j + l], uint(k));
            }
            neighbors.x[j] = x[0];
            previous.x[j] = x[1];
            next.x[j] = x[5];
            float sum = add(x[0], x[1]);
            for (int l = 2; l < 6; ++l) {
                sum = add(sum, x[l]);
            }
            tips.x[j] = addProduct(add(next.x[j], previous.x[j]), w.x[51], sum);
        }
        Six pairs;
        for (int j = 0; j < 6; ++j) {
            pairs.x[j] = add(next.x[j], previous.x[(j + 1) % 6]);
        }
        Waves wavesOfVertices = findWavesOfCorners(ofVertices);
        Waves wavesOfNeighbors = findWavesOfCorners(neighbors);
        Waves wavesOfPairs = findWavesOfEdges(pairs);

        Six points =
            addWaves(weighSymmetric(w, 0, wavesOfVertices, wavesOfNeighbors, wavesOfPairs));
        PLACE result = resultOffset + PLACE(firstFVertex + corner) * resultStride + PLACE(k);
        for (int j = 0; j < 6; ++j) {
            results[result + PLACE(j) * resultStride] = addProduct(points.x[j], w.x[17], tips.x[j]);
        }
        if (hasDerivatives != 0u) {
            Six du =
                addWaves(weighSymmetric(w, 18, wavesOfVertices, wavesOfNeighbors, wavesOfPairs));
            Six dv = addWaves(
                weighAntisymmetric(w, 36, wavesOfVertices, wavesOfNeighbors, wavesOfPairs));
            PLACE duResult = duOffset + PLACE(firstFVertex + corner) * duStride + PLACE(k);
            PLACE dvResult = dvOffset + PLACE(firstFVertex + corner) * dvStride + PLACE(k);
            for (int j = 0; j < 6; ++j) {
                float x = addProduct(du.x[j], w.x[35], tips.x[j]);
                x = addProduct(x, w.x[49], dv.x[j]);
                duResults[duResult + PLACE(j) * duStride] = x;
                dvResults[dvResult + PLACE(j) * dvStride] = addProduct(dv.x[j], w.x[50], x);
            }
        }
    }
}

// The limit of a DeviceLimitVertex.
FUNCTION void makeListedLimit(uint i) {
    PLACE place = firstIndex + PLACE(4) * PLACE(i);
    uint vert = indices[place];
    uint numSources = indices[place + PLACE(1)];
    PLACE next = PLACE(indices[place + PLACE(2)]);
    PLACE first = PLACE(indices[place + PLACE(3)]);
    Element point = getZero();
    Element du = getZero();
    Element dv = getZero();
    for (uint j = 0u; j < numSources; ++j) {
        Element e = getSource(indices[next + PLACE(j)]);
        PLACE weight = first + PLACE(3) * PLACE(j);
        addTo(point, weights[weight], e);
        if (hasDerivatives != 0u) {
            addTo(du, weights[weight + PLACE(1)], e);
            addTo(dv, weights[weight + PLACE(2)], e);
        }
    }
    store(vert, point);
    if (hasDerivatives != 0u) {
        PLACE duResult = duOffset + PLACE(vert) * duStride;
        PLACE dvResult = dvOffset + PLACE(vert) * dvStride;
        for (int k = 0; k < LENGTH; ++k) {
            duResults[duResult + PLACE(k)] = du.x[k];
            dvResults[dvResult + PLACE(k)] = dv.x[k];
        }
    }
}
