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

FUNCTION float weigh3(int first, float ofVertices, float ofNeighbors, float ofPairs) {
    float sum = multiply(regularWeights[first], ofVertices);
    sum = addProduct(sum, regularWeights[first + 1], ofNeighbors);
    return addProduct(sum, regularWeights[first + 2], ofPairs);
}

// By SymmetricWeights, the first of which has a place.
FUNCTION Waves weighSymmetric(int first, Waves verts, Waves neighbors, Waves pairs) {
    Waves result;
    result.mean = weigh3(first, verts.mean, neighbors.mean, pairs.mean);
    result.cosine1 = weigh3(first + 3, verts.cosine1, neighbors.cosine1, pairs.cosine1);
    result.sine1 = weigh3(first + 6, verts.sine1, neighbors.sine1, pairs.sine1);
    result.cosine2 = weigh3(first + 9, verts.cosine2, neighbors.cosine2, pairs.cosine2);
    result.sine2 = weigh3(first + 12, verts.sine2, neighbors.sine2, pairs.sine2);
    result.alternating = addProduct(multiply(regularWeights[first + 15], verts.alternating),
                                    regularWeights[first + 16], neighbors.alternating);
    return result;
}

// By AntisymmetricWeights, likewise.
FUNCTION Waves weighAntisymmetric(int first, Waves verts, Waves neighbors, Waves pairs) {
    Waves result;
    result.mean = 0.0f;
    result.cosine1 = weigh3(first, verts.sine1, neighbors.sine1, pairs.sine1);
    result.sine1 = weigh3(first + 3, verts.cosine1, neighbors.cosine1, pairs.cosine1);
    result.cosine2 = weigh3(first + 6, verts.sine2, neighbors.sine2, pairs.sine2);
    result.sine2 = weigh3(first + 9, verts.cosine2, neighbors.cosine2, pairs.cosine2);
    result.alternating = multiply(regularWeights[first + 12], pairs.alternating);
    return result;
}

// The vertices of a regular face, and of each face beyond, from the neighbour on.
struct Neighborhood {
    uint verts[6];
    uint around[36];
};

FUNCTION float getSourceFloat(uint vert, uint k) {
    return READ(sources, sourceOffset + PLACE(vert) * sourceStride + PLACE(k));
}

// Float k of six vertices, from vert on.
FUNCTION void makeSixLimits(REFERENCE(Neighborhood) of, uint vert, uint k, bool hasOneTip) {
    Six ofVertices;
    Six neighbors;
    Six next;
    Six previous;
    Six beyond;
    Six tips;
    for (int j = 0; j < 6; ++j) {
        ofVertices.x[j] = getSourceFloat(of.verts[j], k);
        float x[6];
        for (int l = 0; l < 6; ++l) {
            x[l] = getSourceFloat(of.around[6 * j + l], k);
        }
        neighbors.x[j] = x[0];
        previous.x[j] = x[1];
        next.x[j] = x[5];
        float sum = add(x[0], x[1]);
        for (int l = 2; l < 6; ++l) {
            sum = add(sum, x[l]);
        }
        beyond.x[j] = sum;
        tips.x[j] = addProduct(add(next.x[j], previous.x[j]), regularWeights[51], sum);
    }
    Six pairs;
    for (int j = 0; j < 6; ++j) {
        pairs.x[j] = add(next.x[j], previous.x[(j + 1) % 6]);
    }
    Waves wavesOfVertices = findWavesOfCorners(ofVertices);
    Waves wavesOfNeighbors = findWavesOfCorners(neighbors);
    Waves wavesOfPairs = findWavesOfEdges(pairs);

    Six points = addWaves(weighSymmetric(0, wavesOfVertices, wavesOfNeighbors, wavesOfPairs));
    PLACE result = resultOffset + PLACE(vert) * resultStride + PLACE(k);
    for (int j = 0; j < 6; ++j) {
        results[result + PLACE(j) * resultStride] =
            addProduct(points.x[j], regularWeights[17], tips.x[j]);
    }
    if (hasDerivatives != 0u) {
        Six du = addWaves(weighSymmetric(18, wavesOfVertices, wavesOfNeighbors, wavesOfPairs));
        Six dv = addWaves(weighAntisymmetric(36, wavesOfVertices, wavesOfNeighbors, wavesOfPairs));
        PLACE duResult = duOffset + PLACE(vert) * duStride + PLACE(k);
        PLACE dvResult = dvOffset + PLACE(vert) * dvStride + PLACE(k);
        for (int j = 0; j < 6; ++j) {
            float tip = tips.x[j];
            float across = dv.x[j];
            if (!hasOneTip) {
                tip = addProduct(add(next.x[j], previous.x[j]), regularWeights[52], beyond.x[j]);
                across = addProduct(across, regularWeights[53], add(next.x[j], -previous.x[j]));
            }
            float x = addProduct(du.x[j], regularWeights[35], tip);
            x = addProduct(x, regularWeights[49], across);
            duResults[duResult + PLACE(j) * duStride] = x;
            dvResults[dvResult + PLACE(j) * dvStride] = addProduct(across, regularWeights[50], x);
        }
    }
}

// All floats: the first ones outside of a loop, which compilers of OpenGL do not unroll where as much is
// in it.
FUNCTION void makeLimitsOfFace(REFERENCE(Neighborhood) of, uint vert, bool hasOneTip) {
    makeSixLimits(of, vert, 0u, hasOneTip);
    if (LENGTH > 1) {
        makeSixLimits(of, vert, 1u, hasOneTip);
    }
    if (LENGTH > 2) {
        makeSixLimits(of, vert, 2u, hasOneTip);
    }
    for (int k = 3; k < LENGTH; ++k) {
        makeSixLimits(of, vert, uint(k), hasOneTip);
    }
}

// getVertexOfCorner() without a branch.
FUNCTION uint selectVertexOfCorner(uint corner) {
    bool isListed = corner >= numConsecutiveCorners;
    uint listed = READ(listedVertices,
                       firstListedVertex + PLACE(isListed ? corner - numConsecutiveCorners : 0u));
    return isListed ? listed : firstConsecutiveVertex + corner;
}

// The F-vertices of a DeviceRegularFace.
FUNCTION void makeRegularLimit(uint i) {
    PLACE place = firstIndex + PLACE(8) * PLACE(i);
    uint corner = READ(indices, place);
    uint locals = READ(indices, place + PLACE(7));
    Neighborhood of;
    for (int j = 0; j < 6; ++j) {
        of.verts[j] = selectVertexOfCorner(corner + uint(j));
        uint beyond = READ(indices, place + PLACE(1 + j));
        uint local = (locals >> uint(3 * j)) & 7u;
        for (int l = 0; l < 6; ++l) {
            uint turned = local + uint(l);
            of.around[6 * j + l] =
                selectVertexOfCorner(beyond + (turned < 6u ? turned : turned - 6u));
        }
    }
    makeLimitsOfFace(of, firstFVertex + corner, true);
}

// The vertices of a DeviceOwnFace.
FUNCTION void makeOwnLimit(uint i) {
    PLACE place = firstIndex + PLACE(37) * PLACE(i);
    uint vert = READ(indices, place);
    Neighborhood of;
    for (int j = 0; j < 6; ++j) {
        of.verts[j] = vert + uint(j);
        for (int l = 0; l < 6; ++l) {
            of.around[6 * j + l] = READ(indices, place + PLACE(1 + 6 * j + l));
        }
    }
    makeLimitsOfFace(of, vert, false);
}

// The limit of a DeviceLimitVertex.
FUNCTION void makeListedLimit(uint i) {
    PLACE place = firstIndex + PLACE(4) * PLACE(i);
    uint vert = READ(indices, place);
    uint numSources = READ(indices, place + PLACE(1));
    PLACE next = PLACE(READ(indices, place + PLACE(2)));
    PLACE first = PLACE(READ(indices, place + PLACE(3)));
    Element point = getZero();
    Element du = getZero();
    Element dv = getZero();
    for (uint j = 0u; j < numSources; ++j) {
        Element e = getSource(READ(indices, next + PLACE(j)));
        PLACE weight = first + PLACE(3) * PLACE(j);
        addTo(point, READ(weights, weight), e);
        if (hasDerivatives != 0u) {
            addTo(du, READ(weights, weight + PLACE(1)), e);
            addTo(dv, READ(weights, weight + PLACE(2)), e);
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
