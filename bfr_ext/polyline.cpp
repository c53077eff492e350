// SPDX-License-Identifier: Apache-2.0
#include "polyline.h"

#include <algorithm>

namespace OpenSubdivHex::BfrExt {

namespace {

using Place = Polyline::Place;
using Places = std::vector<Place>;

// Adds what lies inside of a segment that is an edge, or a long one, at \p level.
void addPoints(int start, int end, bool isLong, int level, int lastLevel, Places &places) {
    if (level >= lastLevel) {
        return;
    }
    if (!isLong) {
        addPoints(start, end, true, level + 1, lastLevel, places);
        return;
    }
    int const first = start + (end - start) / 4;
    int const second = end - (end - start) / 4;
    addPoints(start, first, false, level + 1, lastLevel, places);
    places.push_back(Place(first));
    addPoints(first, second, true, level + 1, lastLevel, places);
    places.push_back(Place(second));
    addPoints(second, end, false, level + 1, lastLevel, places);
}

// Whether the places [begin, end) cut the segment as refinement does.
bool areOfSegment(int start, int end, Place const *placesBegin, Place const *placesEnd) {
    if (placesBegin == placesEnd) {
        return true;
    }
    if ((end - start) % 4 != 0) {
        return false;
    }
    int const first = start + (end - start) / 4;
    int const second = end - (end - start) / 4;
    Place const *const atFirst = std::lower_bound(placesBegin, placesEnd, Place(first));
    Place const *const atSecond = std::lower_bound(atFirst, placesEnd, Place(second));
    return atFirst != placesEnd && *atFirst == first && atSecond != placesEnd &&
           *atSecond == second && areOfSegment(start, first, placesBegin, atFirst) &&
           areOfSegment(first, second, atFirst + 1, atSecond) &&
           areOfSegment(second, end, atSecond + 1, placesEnd);
}

} // namespace

Polyline::Polyline(int level) { addPoints(0, kLength, false, 0, level, _places); }

bool Polyline::FromPlaces(Places const &places, Polyline *polyline) {
    bool const isAscending = std::adjacent_find(places.begin(), places.end(), [](Place a, Place b) {
                                 return a >= b;
                             }) == places.end();
    bool const isInside = places.empty() || (places.front() > 0 && int(places.back()) < kLength);
    if (!isAscending || !isInside ||
        !areOfSegment(0, kLength, places.data(), places.data() + places.size())) {
        return false;
    }
    polyline->_places = places;
    return true;
}

Polyline Polyline::GetReversed() const {
    Polyline result;
    result._places.reserve(_places.size());
    std::for_each(_places.rbegin(), _places.rend(),
                  [&](Place place) { result._places.push_back(Place(kLength - place)); });
    return result;
}

void Polyline::Merge(Polyline const &other) {
    if (Contains(other)) {
        return;
    }
    Places merged;
    merged.reserve(_places.size() + other._places.size());
    std::set_union(_places.begin(), _places.end(), other._places.begin(), other._places.end(),
                   std::back_inserter(merged));
    _places = std::move(merged);
}

bool Polyline::Contains(Polyline const &other) const {
    return std::includes(_places.begin(), _places.end(), other._places.begin(),
                         other._places.end());
}

} // namespace OpenSubdivHex::BfrExt
