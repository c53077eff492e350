// SPDX-License-Identifier: Apache-2.0
//
// The kernels of limits, behind those of kernels.inl: the arithmetic of limitKernelTemplate.h.

// Numbers of the corners of a regular face.
struct Six {
    float x[6];
};

// The frequencies of values around a regular face: see limitKernelTemplate.h.
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
    return sources[sourceOffset + PLACE(vert) * sourceStride + PLACE(k)];
}

// Float k of six vertices, from vert on.
FUNCTION void makeSixLimits(REFERENCE(Neighborhood) of, uint vert, uint k) {
    Six ofVertices;
    Six neighbors;
    Six next;
    Six previous;
    Six others;
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
        others.x[j] = add(x[2], add(x[3], x[4]));
        tips.x[j] = addProduct(add(next.x[j], previous.x[j]), regularWeights[51], others.x[j]);
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
            float tip = addProduct(add(next.x[j], previous.x[j]), regularWeights[52], others.x[j]);
            float across = addProduct(dv.x[j], regularWeights[53], add(next.x[j], -previous.x[j]));
            float x = addProduct(du.x[j], regularWeights[35], tip);
            x = addProduct(x, regularWeights[49], across);
            duResults[duResult + PLACE(j) * duStride] = x;
            dvResults[dvResult + PLACE(j) * dvStride] = addProduct(across, regularWeights[50], x);
        }
    }
}

FUNCTION void makeLimitsOfFace(REFERENCE(Neighborhood) of, uint vert) {
    for (int k = 0; k < LENGTH; ++k) {
        makeSixLimits(of, vert, uint(k));
    }
}

// The F-vertices of a DeviceRegularFace.
FUNCTION void makeRegularLimit(uint i) {
    PLACE place = firstIndex + PLACE(8) * PLACE(i);
    uint corner = indices[place];
    uint locals = indices[place + PLACE(7)];
    Neighborhood of;
    for (int j = 0; j < 6; ++j) {
        of.verts[j] = getVertexOfCorner(corner + uint(j));
        uint beyond = indices[place + PLACE(1 + j)];
        uint local = (locals >> uint(3 * j)) & 7u;
        for (int l = 0; l < 6; ++l) {
            uint turned = local + uint(l);
            of.around[6 * j + l] = getVertexOfCorner(beyond + (turned < 6u ? turned : turned - 6u));
        }
    }
    makeLimitsOfFace(of, firstFVertex + corner);
}

// The vertices of a DeviceOwnFace.
FUNCTION void makeOwnLimit(uint i) {
    PLACE place = firstIndex + PLACE(37) * PLACE(i);
    uint vert = indices[place];
    Neighborhood of;
    for (int j = 0; j < 6; ++j) {
        of.verts[j] = vert + uint(j);
        for (int l = 0; l < 6; ++l) {
            of.around[6 * j + l] = indices[place + PLACE(1 + 6 * j + l)];
        }
    }
    makeLimitsOfFace(of, vert);
}

// Lattice faces: the arithmetic of latticeKernelTemplate.h.

// The waves of an orbit around the face stand in a Six: the mean, what alternates with 4 and 6 corners,
// then cosine and sine of each frequency.
FUNCTION int getNumSingleWaves() { return SIZE % 2 == 0 ? 2 : 1; }
FUNCTION int getNumFrequencies() { return (SIZE - 1) / 2; }
// Orbits of sources, as LatticeOrbits has them: those on axes and the sums of pairs, and differences.
FUNCTION int getNumAxes() { return SIZE == 4 ? 2 : 3; }
FUNCTION int getNumDifferences() { return SIZE == 6 ? 2 : 3; }
FUNCTION int getNumSums() { return getNumAxes() + getNumDifferences(); }

// The sine of 60 degrees.
FUNCTION float getSine() { return 0.86602540378443864676f; }

FUNCTION Six findLatticeWaves(Six at) {
    Six waves;
    if (SIZE == 3) {
        float sum = add(at.x[1], at.x[2]);
        waves.x[0] = add(at.x[0], sum);
        waves.x[1] = addProduct(at.x[0], -0.5f, sum);
        waves.x[2] = multiply(getSine(), add(at.x[2], -at.x[1]));
    } else if (SIZE == 4) {
        float even = add(at.x[0], at.x[2]);
        float odd = add(at.x[1], at.x[3]);
        waves.x[0] = add(even, odd);
        waves.x[1] = add(even, -odd);
        waves.x[2] = add(at.x[0], -at.x[2]);
        waves.x[3] = add(at.x[3], -at.x[1]);
    } else {
        Waves of = findWavesOfCorners(at);
        waves.x[0] = of.mean;
        waves.x[1] = of.alternating;
        waves.x[2] = of.cosine1;
        waves.x[3] = multiply(-getSine(), of.sine1);
        waves.x[4] = of.cosine2;
        waves.x[5] = multiply(-getSine(), of.sine2);
    }
    return waves;
}

FUNCTION Six findLatticeValues(Six waves) {
    Six at;
    if (SIZE == 3) {
        float rest = addProduct(waves.x[0], -0.5f, waves.x[1]);
        at.x[0] = add(waves.x[0], waves.x[1]);
        at.x[1] = addProduct(rest, -getSine(), waves.x[2]);
        at.x[2] = addProduct(rest, getSine(), waves.x[2]);
    } else if (SIZE == 4) {
        float even = add(waves.x[0], waves.x[1]);
        float odd = add(waves.x[0], -waves.x[1]);
        at.x[0] = add(even, waves.x[2]);
        at.x[1] = add(odd, -waves.x[3]);
        at.x[2] = add(even, -waves.x[2]);
        at.x[3] = add(odd, waves.x[3]);
    } else {
        Waves of;
        of.mean = waves.x[0];
        of.alternating = waves.x[1];
        of.cosine1 = waves.x[2];
        of.sine1 = multiply(-getSine(), waves.x[3]);
        of.cosine2 = waves.x[4];
        of.sine2 = multiply(-getSine(), waves.x[5]);
        at = addWaves(of);
    }
    return at;
}

// The vertices of all sources of a face, by place.
struct LatticePlaces {
    uint verts[42];
};
// The waves of the sources: getNumSums() of them, then getNumDifferences(), which are turned by a quarter.
struct LatticeSources {
    Six waves[9];
};

FUNCTION Six getOrbit(REFERENCE(LatticePlaces) places, int orbit, uint k) {
    Six at;
    for (int corner = 0; corner < SIZE; ++corner) {
        at.x[corner] = getSourceFloat(places.verts[orbit * SIZE + corner], k);
    }
    return at;
}

FUNCTION void findLatticeSources(REFERENCE(LatticePlaces) places, uint k,
                                 REFERENCE(LatticeSources) of) {
    for (int i = 0; i < getNumAxes(); ++i) {
        of.waves[i] = findLatticeWaves(getOrbit(places, i, k));
    }
    for (int i = 0; i < getNumDifferences(); ++i) {
        Six first = getOrbit(places, getNumAxes() + 2 * i, k);
        Six second = getOrbit(places, getNumAxes() + 2 * i + 1, k);
        Six sum;
        Six difference;
        for (int corner = 0; corner < SIZE; ++corner) {
            sum.x[corner] = add(first.x[corner], second.x[corner]);
            difference.x[corner] = add(first.x[corner], -second.x[corner]);
        }
        of.waves[getNumAxes() + i] = findLatticeWaves(sum);
        Six waves = findLatticeWaves(difference);
        for (int j = 0; j < getNumFrequencies(); ++j) {
            int cosine = getNumSingleWaves() + 2 * j;
            float sine = waves.x[cosine + 1];
            waves.x[cosine + 1] = waves.x[cosine];
            waves.x[cosine] = -sine;
        }
        of.waves[getNumSums() + i] = waves;
    }
}

// An output of both orbits of a pair.
struct PairOfSixes {
    Six first;
    Six second;
};

// Output number sum, of three, of the pair whose weights begin at first.
FUNCTION PairOfSixes weighLattice(REFERENCE(LatticeSources) of, int first, int sum) {
    Six even;
    Six odd;
    int numAll = getNumSums() + getNumDifferences();
    for (int wave = 0; wave < getNumSingleWaves(); ++wave) {
        int at = 3 * numAll * wave + sum;
        even.x[wave] = multiply(latticeWeights[first + at], of.waves[0].x[wave]);
        for (int i = 1; i < getNumSums(); ++i) {
            even.x[wave] =
                addProduct(even.x[wave], latticeWeights[first + at + 3 * i], of.waves[i].x[wave]);
        }
        at = at + 3 * getNumSums();
        odd.x[wave] = multiply(latticeWeights[first + at], of.waves[getNumSums()].x[wave]);
        for (int i = 1; i < getNumDifferences(); ++i) {
            odd.x[wave] = addProduct(odd.x[wave], latticeWeights[first + at + 3 * i],
                                     of.waves[getNumSums() + i].x[wave]);
        }
    }
    for (int i = 0; i < getNumFrequencies(); ++i) {
        int cosine = getNumSingleWaves() + 2 * i;
        int sine = cosine + 1;
        int at = 3 * numAll * cosine + 2 * sum;
        even.x[cosine] = multiply(latticeWeights[first + at], of.waves[0].x[cosine]);
        even.x[sine] = multiply(latticeWeights[first + at], of.waves[0].x[sine]);
        odd.x[sine] = multiply(latticeWeights[first + at + 1], of.waves[0].x[cosine]);
        odd.x[cosine] = multiply(latticeWeights[first + at + 1], of.waves[0].x[sine]);
        for (int j = 1; j < numAll; ++j) {
            at = at + 6;
            even.x[cosine] =
                addProduct(even.x[cosine], latticeWeights[first + at], of.waves[j].x[cosine]);
            even.x[sine] =
                addProduct(even.x[sine], latticeWeights[first + at], of.waves[j].x[sine]);
            odd.x[sine] =
                addProduct(odd.x[sine], latticeWeights[first + at + 1], of.waves[j].x[cosine]);
            odd.x[cosine] =
                addProduct(odd.x[cosine], latticeWeights[first + at + 1], of.waves[j].x[sine]);
        }
    }
    Six halfSum = findLatticeValues(even);
    Six halfDifference = findLatticeValues(odd);
    PairOfSixes result;
    for (int corner = 0; corner < SIZE; ++corner) {
        float inMirror = halfDifference.x[(SIZE - corner) % SIZE];
        result.first.x[corner] = add(halfSum.x[corner], inMirror);
        result.second.x[corner] = add(halfSum.x[corner], -inMirror);
    }
    return result;
}

// Where another face makes the vertex.
FUNCTION uint getNoVertex() { return 0xffffffffu; }

// The vertices of an orbit on an axis, or of one of a pair.
struct LatticeOutputs {
    uint verts[6];
};

FUNCTION LatticeOutputs getOutputs(PLACE place) {
    LatticeOutputs outputs;
    for (int corner = 0; corner < SIZE; ++corner) {
        outputs.verts[corner] = indices[place + PLACE(corner) * PLACE(numFaces)];
    }
    return outputs;
}

FUNCTION void storePoints(REFERENCE(LatticeOutputs) outputs, uint k, Six point) {
    for (int corner = 0; corner < SIZE; ++corner) {
        uint vert = outputs.verts[corner];
        if (vert != getNoVertex()) {
            results[resultOffset + PLACE(vert) * resultStride + PLACE(k)] = point.x[corner];
        }
    }
}
FUNCTION void storeDerivatives(REFERENCE(LatticeOutputs) outputs, uint k, Six du, Six dv) {
    for (int corner = 0; corner < SIZE; ++corner) {
        uint vert = outputs.verts[corner];
        if (vert != getNoVertex()) {
            duResults[duOffset + PLACE(vert) * duStride + PLACE(k)] = du.x[corner];
            dvResults[dvOffset + PLACE(vert) * dvStride + PLACE(k)] = dv.x[corner];
        }
    }
}

// How many weights AddOrbitWeights makes.
FUNCTION int getNumWeights() {
    return 3 * (getNumSums() + getNumDifferences()) *
               (getNumSingleWaves() + 2 * getNumFrequencies()) +
           4;
}

// Float k of an orbit whose weights begin at first; of a pair that of its mirror images, too.
FUNCTION void makeOrbit(REFERENCE(LatticeSources) of, REFERENCE(LatticeOutputs) outputs,
                        REFERENCE(LatticeOutputs) images, int first, uint k, bool isPair) {
    PairOfSixes point = weighLattice(of, first, 0);
    storePoints(outputs, k, point.first);
    if (isPair) {
        storePoints(images, k, point.second);
    }
    if (hasDerivatives != 0u) {
        PairOfSixes du = weighLattice(of, first, 1);
        PairOfSixes dv = weighLattice(of, first, 2);
        storeDerivatives(outputs, k, du.first, dv.first);
        if (isPair) {
            int ofDerivatives = getNumWeights() - 4;
            for (int corner = 0; corner < SIZE; ++corner) {
                float u = du.second.x[corner];
                float v = dv.second.x[corner];
                du.second.x[corner] =
                    addProduct(multiply(latticeWeights[first + ofDerivatives + 1], v),
                               latticeWeights[first + ofDerivatives], u);
                dv.second.x[corner] =
                    addProduct(multiply(latticeWeights[first + ofDerivatives + 3], v),
                               latticeWeights[first + ofDerivatives + 2], u);
            }
            storeDerivatives(images, k, du.second, dv.second);
        }
    }
}

// A float of some orbits of a lattice face, pairs first, whose indices stand place after place, of all faces
// in turn.
FUNCTION void makeLatticeLimit(uint i) {
    uint face = i / numFloats;
    uint k = i - face * numFloats;
    LatticePlaces places;
    for (int orbit = 0; orbit < getNumAxes() + 2 * getNumDifferences(); ++orbit) {
        for (int corner = 0; corner < SIZE; ++corner) {
            int number = orbit * SIZE + corner;
            places.verts[number] =
                indices[firstIndex + PLACE(number) * PLACE(numFaces) + PLACE(face)];
        }
    }
    LatticeSources of;
    findLatticeSources(places, k, of);
    PLACE place = firstOutput + PLACE(face);
    PLACE next = PLACE(SIZE) * PLACE(numFaces);
    int first = 0;
    for (uint orbit = 0u; orbit < numOrbits; ++orbit) {
        bool isPair = orbit < numPairs;
        LatticeOutputs outputs = getOutputs(place);
        place = place + next;
        LatticeOutputs images = outputs;
        if (isPair) {
            images = getOutputs(place);
            place = place + next;
        }
        makeOrbit(of, outputs, images, first, k, isPair);
        first = first + getNumWeights();
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
