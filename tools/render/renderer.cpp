// SPDX-License-Identifier: Apache-2.0
#include "renderer.h"

#include <atomic>
#include <random>
#include <thread>
#include <utility>

namespace OpenSubdivHex::Tools {

namespace {

constexpr float kPi = 3.14159265f;

// Colours are linear; those that are displayed without lighting have been tone mapped.
constexpr Vec3 kBackground{0.915f, 0.915f, 0.915f};
constexpr Vec3 kSurfaceColor{0.70f, 0.255f, 0.105f};
constexpr Vec3 kTintColor{0.115f, 0.30f, 0.42f};
constexpr Vec3 kLineColor{0.035f, 0.028f, 0.030f};
constexpr Vec3 kRodColor{0.10f, 0.17f, 0.26f};
constexpr Vec3 kZebraLight{0.84f, 0.84f, 0.84f};
constexpr Vec3 kZebraDark{0.025f, 0.035f, 0.06f};

constexpr float kKeyLight = 0.92f;
constexpr float kKeyLightSize = 0.12f; // radius by distance
constexpr Vec3 kZenith{0.62f, 0.68f, 0.77f};
constexpr Vec3 kHorizon{0.46f, 0.47f, 0.50f};
constexpr Vec3 kGroundLight{0.30f, 0.28f, 0.26f};
constexpr float kRoughness = 0.34f;
constexpr float kReflectance = 0.04f; // at normal incidence
constexpr float kZebraStripes = 11;   // of each colour, in a full turn

/// Light from \p direction where nothing is in the way.
Vec3 computeSky(Vec3 direction) {
    return direction.y < 0 ? kGroundLight : Mix(kHorizon, kZenith, direction.y);
}

float computeFresnel(float cosine) {
    return kReflectance + (1 - kReflectance) * std::pow(1 - cosine, 5.0f);
}

/// The microfacet term (GGX) of a light in direction \p light, without Fresnel's factor.
float computeHighlight(Vec3 normal, Vec3 view, Vec3 light) {
    constexpr float kAlpha2 = kRoughness * kRoughness * kRoughness * kRoughness;
    float const cosHalf = Dot(normal, Normalize(view + light));
    float const d = cosHalf * cosHalf * (kAlpha2 - 1) + 1;
    float const cosLight = std::fmax(Dot(normal, light), 0.0f);
    float const cosView = std::fmax(Dot(normal, view), 0.05f);
    float const k = (kRoughness + 1) * (kRoughness + 1) / 8;
    float const masking = (cosLight * (1 - k) + k) * (cosView * (1 - k) + k);
    return kAlpha2 / (d * d) * cosLight / (4 * masking);
}

/// Khronos' PBR Neutral tone mapper: keeps colours as they are up to 0.8, and hues above.
Vec3 mapTones(Vec3 color) {
    constexpr float kStart = 0.8f - 0.04f;
    constexpr float kDesaturation = 0.15f;
    float const low = std::fmin(color.x, std::fmin(color.y, color.z));
    float const offset = low < 0.08f ? low - 6.25f * low * low : 0.04f;
    color = color - Vec3{offset, offset, offset};
    float const peak = std::fmax(color.x, std::fmax(color.y, color.z));
    if (peak < kStart) {
        return color;
    }
    float const newPeak = 1 - (1 - kStart) * (1 - kStart) / (peak + 1 - 2 * kStart);
    float const gray = 1 - 1 / (kDesaturation * (peak - newPeak) + 1);
    return Mix((newPeak / peak) * color, {newPeak, newPeak, newPeak}, gray);
}

std::uint8_t encodeSrgb(float value) {
    value = std::fmin(std::fmax(value, 0.0f), 1.0f);
    value = value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1 / 2.4f) - 0.055f;
    return std::uint8_t(255 * value + 0.5f);
}

/// One for each face of the control mesh: hues that turn by the golden section.
Vec3 getRegionColor(int baseFace) {
    float const turn = 0.618034f * float(baseFace);
    float const hue = 6 * (turn - std::floor(turn));
    auto const ramp = [&](float place) {
        float const distance = std::fabs(std::fmod(hue - place + 9, 6.0f) - 3);
        return 0.11f + 0.44f * std::fmin(std::fmax(distance - 1, 0.0f), 1.0f);
    };
    return {ramp(0), ramp(2), ramp(4)};
}

/// Two axes at right angles to \p normal and to each other.
std::pair<Vec3, Vec3> findTangents(Vec3 normal) {
    Vec3 const axis = std::fabs(normal.y) < 0.9f ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    Vec3 const tangent = Normalize(Cross(axis, normal));
    return {tangent, Cross(normal, tangent)};
}

/// A point of the unit square, or of the unit disk.
struct Sample {
    float x, y;
};

/// \p count points spread evenly over the unit square, in an order that is always the same but
/// follows no pattern.
std::vector<Sample> makeSamples(int count, std::mt19937::result_type seed) {
    std::vector<Sample> samples;
    for (int i = 0; i < count; ++i) {
        // Hammersley's points: the second coordinate mirrors the binary digits of i.
        float mirrored = 0;
        float digit = 0.5f;
        for (int rest = i; rest > 0; rest /= 2, digit /= 2) {
            mirrored += digit * float(rest % 2);
        }
        samples.push_back({(float(i) + 0.5f) / float(count), mirrored + 0.5f / float(count)});
    }
    // std::shuffle may differ from one library to the next.
    std::mt19937 random(seed);
    for (std::size_t i = samples.size(); i > 1; --i) {
        std::swap(samples[i - 1], samples[random() % i]);
    }
    return samples;
}

/// From the unit square to the unit disk.
std::vector<Sample> mapToDisk(std::vector<Sample> samples) {
    for (Sample &sample : samples) {
        float const radius = std::sqrt(sample.x);
        float const angle = 2 * kPi * sample.y;
        sample = {radius * std::cos(angle), radius * std::sin(angle)};
    }
    return samples;
}

/// Places in a pixel around its center (0, 0), denser towards it: a tent filter.
std::vector<Sample> mapToTent(std::vector<Sample> samples) {
    constexpr float kRadius = 0.8f;
    auto const map = [](float x) {
        return kRadius * (x < 0.5f ? std::sqrt(2 * x) - 1 : 1 - std::sqrt(2 - 2 * x));
    };
    for (Sample &sample : samples) {
        sample = {map(sample.x), map(sample.y)};
    }
    return samples;
}

class Tracer {
public:
    Tracer(Scene const &scene, Camera const &camera, RenderOptions const &options, int width,
           int height)
        : _scene(scene), _camera(camera), _options(options), _width(float(width)),
          _height(float(height)), _pixelSamples(mapToTent(makeSamples(options.numSamples, 1))),
          _keySamples(mapToDisk(makeSamples(Scene::kNumRays * options.numSamples, 2))),
          _skySamples(mapToDisk(makeSamples(Scene::kNumRays * options.numSamples, 3))) {
        Vec3 const front = Cross(camera.GetRight(), Vec3{0, 1, 0});
        _key = Normalize(-0.75f * camera.GetRight() + Vec3{0, 1, 0} + 0.5f * front);
        _keyTangents = findTangents(_key);
        _offset = 2e-4f * Length(scene.GetHigh() - scene.GetLow());
    }

    void TraceRow(int y, Image *image) const {
        for (int x = 0; x < image->width; ++x) {
            Vec3 sum;
            for (int sample = 0; sample < _options.numSamples; ++sample) {
                Sample const place = _pixelSamples[sample];
                sum = sum + trace((float(x) + 0.5f + place.x) / _width,
                                  (float(y) + 0.5f + place.y) / _height, sample);
            }
            Vec3 const color = (1 / float(_options.numSamples)) * sum;
            std::uint8_t *const pixel = image->GetPixel(x, y);
            pixel[0] = encodeSrgb(color.x);
            pixel[1] = encodeSrgb(color.y);
            pixel[2] = encodeSrgb(color.z);
        }
    }

private:
    /// Light at a point: the part of each light that is not in the shadow.
    struct Light {
        float key;     ///< 0 to 1, without the angle of incidence
        Vec3 sky;      ///< with the angle of incidence
        float skyPart; ///< 0 to 1
    };

    Vec3 trace(float x, float y, int sample) const {
        Vec3 const direction = _camera.GetDirection(x, y);
        Scene::Hit hit;
        if (_scene.Intersect(_camera.GetPosition(), direction, &hit)) {
            return mapTones(shade(hit, direction, sample));
        }
        return _options.hasGround ? traceGround(direction, x, y, sample) : kBackground;
    }

    Vec3 shade(Scene::Hit const &hit, Vec3 direction, int sample) const {
        // Both sides of a surface are lit.
        float const side = Dot(hit.normal, direction) > 0 ? -1.0f : 1.0f;
        Vec3 const normal = side * findNormal(hit);
        Vec3 const origin = hit.point + side * _offset * hit.normal;
        Vec3 const reflected = direction - 2 * Dot(direction, normal) * normal;
        Vec3 const color = findColor(hit, reflected);
        Light const light = gatherLight(origin, normal, color, sample);

        Vec3 result = color * (kKeyLight * light.key * std::fmax(Dot(normal, _key), 0.0f) *
                                   Vec3{1, 0.97f, 0.93f} +
                               light.sky);
        if (_options.look != SurfaceLook::Zebra) {
            float const fresnel = computeFresnel(std::fmax(-Dot(normal, direction), 0.0f));
            float const highlight = computeHighlight(normal, -direction, _key);
            result = result + fresnel * (kKeyLight * light.key * highlight * Vec3{1, 1, 1} +
                                         0.7f * computeSky(reflected) * light.sky);
        }
        return result;
    }

    Vec3 findNormal(Scene::Hit const &hit) const {
        if (hit.triangle < 0) {
            return hit.normal;
        }
        return _options.look == SurfaceLook::Flat
                   ? _scene.GetSurface()->GetFlatNormal(hit.triangle)
                   : _scene.GetSurface()->GetSmoothNormal(hit.triangle, hit.u, hit.v);
    }

    Vec3 findColor(Scene::Hit const &hit, Vec3 reflected) const {
        if (hit.triangle < 0) {
            return kRodColor;
        }
        if (_options.hasWireframe) {
            float const pixel = _camera.GetPictureHeight(hit.point) / _height;
            float const distance = _scene.GetSurface()->GetEdgeDistance(hit.triangle, hit.point);
            if (distance < 0.5f * _options.lineWidth * pixel) {
                return kLineColor;
            }
        }
        if (_options.look == SurfaceLook::Zebra) {
            float const cosine = std::fmin(std::fmax(Dot(reflected, _camera.GetUp()), -1.0f), 1.0f);
            float const stripe = std::sin(kZebraStripes * std::acos(cosine));
            return Mix(kZebraDark, kZebraLight, SmoothStep(-0.12f, 0.12f, stripe));
        }
        if (_options.hasRegions) {
            int const baseFace = _scene.GetSurface()->GetBaseFace(hit.triangle);
            return getRegionColor(
                _options.regions.empty() ? baseFace : _options.regions[std::size_t(baseFace)]);
        }
        bool const isTinted =
            _options.isTinted && _scene.GetSurface()->GetFaceSize(hit.triangle) != 6;
        return isTinted ? kTintColor : kSurfaceColor;
    }

    /// \param color  of the surroundings, which are taken to be like the surface itself
    Light gatherLight(Vec3 origin, Vec3 normal, Vec3 color, int sample) const {
        constexpr int kNumRays = Scene::kNumRays;
        Light light{0, {}, 0};
        Vec3 directions[kNumRays];
        bool isWanted[kNumRays];
        bool isOccluded[kNumRays];

        bool isAnyWanted = false;
        for (int i = 0; i < kNumRays; ++i) {
            Sample const place = _keySamples[std::size_t(sample * kNumRays + i)];
            directions[i] = Normalize(_key + kKeyLightSize * (place.x * _keyTangents.first +
                                                              place.y * _keyTangents.second));
            isWanted[i] = Dot(directions[i], normal) > 0;
            isAnyWanted = isAnyWanted || isWanted[i];
        }
        if (isAnyWanted) {
            _scene.FindOccluded(origin, directions, isWanted, isOccluded);
            for (int i = 0; i < kNumRays; ++i) {
                light.key += isWanted[i] && !isOccluded[i] ? 1.0f / kNumRays : 0.0f;
            }
        }

        auto const [tangent, bitangent] = findTangents(normal);
        for (int i = 0; i < kNumRays; ++i) {
            Sample const place = _skySamples[std::size_t(sample * kNumRays + i)];
            float const height =
                std::sqrt(std::fmax(1 - place.x * place.x - place.y * place.y, 0.0f));
            directions[i] = place.x * tangent + place.y * bitangent + height * normal;
            isWanted[i] = true;
        }
        _scene.FindOccluded(origin, directions, isWanted, isOccluded);
        for (int i = 0; i < kNumRays; ++i) {
            Vec3 const arriving = isOccluded[i] ? 0.3f * color : computeSky(directions[i]);
            light.sky = light.sky + 1.0f / kNumRays * arriving;
            light.skyPart += isOccluded[i] ? 0 : 1.0f / kNumRays;
        }
        return light;
    }

    /// The background, darker where the plane below the scene lies in shadow.
    Vec3 traceGround(Vec3 direction, float x, float y, int sample) const {
        Vec3 const position = _camera.GetPosition();
        float const distance = (_scene.GetLow().y - position.y) / direction.y;
        if (!(distance > 0)) {
            return kBackground;
        }
        // Towards the border of the picture the shadows fade.
        float const aspect = _width / _height;
        float const fromBorder = std::fmin(std::fmin(x, 1 - x) * std::fmax(aspect, 1.0f),
                                           std::fmin(y, 1 - y) * std::fmax(1 / aspect, 1.0f));
        float const strength = 0.9f * SmoothStep(0, 0.14f, fromBorder);
        if (strength == 0) {
            return kBackground;
        }
        Vec3 const up{0, 1, 0};
        Light const light =
            gatherLight(position + distance * direction + _offset * up, up, Vec3(), sample);
        float const key = kKeyLight * _key.y;
        float const sky = Mix(kHorizon, kZenith, 2.0f / 3).y;
        float const shadow = 1 - (key * light.key + sky * light.skyPart) / (key + sky);
        // The faint shadow that reaches far is left out.
        float const visible = shadow * shadow / (shadow + 0.05f);
        return (1 - strength * visible) * kBackground;
    }

    Scene const &_scene;
    Camera const &_camera;
    RenderOptions const &_options;
    float const _width;
    float const _height;
    std::vector<Sample> const _pixelSamples;
    std::vector<Sample> const _keySamples;
    std::vector<Sample> const _skySamples;
    Vec3 _key;
    std::pair<Vec3, Vec3> _keyTangents;
    float _offset; ///< keeps rays from hitting what they start from
};

} // namespace

Image Render(Scene const &scene, Camera const &camera, RenderOptions const &options, int width,
             int height) {
    Image image(width, height);
    Tracer const tracer(scene, camera, options, width, height);
    std::atomic<int> nextRow(0);
    auto const work = [&] {
        for (int y = nextRow++; y < height; y = nextRow++) {
            tracer.TraceRow(y, &image);
        }
    };
    std::vector<std::thread> threads;
    for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) {
        threads.emplace_back(work);
    }
    work();
    for (std::thread &thread : threads) {
        thread.join();
    }
    return image;
}

} // namespace OpenSubdivHex::Tools
