// SPDX-License-Identifier: Apache-2.0
#include "window.h"

#include "animation.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <stdexcept>

namespace OpenSubdivHex::Tools {

namespace {

constexpr char const *kSchemes[] = {"hexagonal", "Doo-Sabin", "tri-hex"};
constexpr char const *kFirstSteps[] = {"none", "tri-hex", "truncate"};
constexpr char const *kMasks[] = {"average", "cosine", "smooth"};
constexpr char const *kBoundaries[] = {"none", "edge only", "edge and corner"};
constexpr char const *kEvaluators[] = {"CPU", "OpenGL", "tables"};
constexpr char const *kShadings[] = {
    "smooth", "facets", "reflection lines", "curvature", "base faces", "checker", "levels"};
constexpr int kMaxLevel = 7;
constexpr float kMinPixelError = 0.1f;
constexpr float kMaxPixelError = 50;
constexpr float kPickRadius = 12; // pixels

/// GLFW and a window of it, with ImGui.
class WindowHandle {
public:
    WindowHandle(std::string const &title, int width, int height) {
        if (!glfwInit()) {
            throw std::runtime_error("there is no display for a window; --png needs none");
        }
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        glfwWindowHint(GLFW_SAMPLES, 4);
        window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
        if (!window) {
            glfwTerminate();
            throw std::runtime_error("there is no window with OpenGL 4.3");
        }
        glfwMakeContextCurrent(window);
        glfwSwapInterval(1);
        // ImGui sees keys that are down when a frame begins; short ones would be lost.
        glfwSetWindowUserPointer(window, &pressedKeys);
        glfwSetKeyCallback(window, [](GLFWwindow *pressed, int key, int, int action, int) {
            if (action == GLFW_PRESS) {
                static_cast<std::vector<int> *>(glfwGetWindowUserPointer(pressed))->push_back(key);
            }
        });
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;
        ImGui_ImplGlfw_InitForOpenGL(window, true);
        ImGui_ImplOpenGL3_Init("#version 430");
    }
    WindowHandle(WindowHandle const &) = delete;
    WindowHandle &operator=(WindowHandle const &) = delete;
    ~WindowHandle() {
        ImGui_ImplOpenGL3_Shutdown();
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
        glfwDestroyWindow(window);
        glfwTerminate();
    }

    GLFWwindow *window = nullptr;
    std::vector<int> pressedKeys; // since the last frame
};

/// A combination box for an enumeration whose values have \p names; whether another was chosen.
template <typename ENUM, std::size_t SIZE>
bool chooseEnum(char const *label, char const *const (&names)[SIZE], ENUM *value) {
    int number = int(*value);
    bool const isChanged = ImGui::Combo(label, &number, names, int(SIZE));
    *value = ENUM(number);
    return isChanged;
}

/// The window: takes the user's input and shows the surface.
class Viewer {
public:
    Viewer(Mesh const &mesh, SurfaceSettings const &settings, DrawSettings const &drawSettings,
           OrbitCamera const &camera)
        : _surface(mesh), _settings(settings), _drawSettings(drawSettings), _camera(camera) {
        _surface.Refine(_settings);
        _refined = _settings;
        if (_settings.creaseAngle) {
            _creaseAngle = float(*_settings.creaseAngle);
        }
    }

    void PressKey(int key);
    void Frame(int width, int height) {
        showPanel();
        readMouse(float(width), float(height));
        if (_isAnimated) {
            animate();
        }
        follow(width, height);
        _painter.Draw(_surface, _camera, _drawSettings, width, height);
    }

private:
    void showPanel();
    void readMouse(float width, float height);
    void showCells();
    void showPatches();
    void refine();
    void follow(int width, int height);
    void animate();
    int findControlVertex(float x, float y, glm::mat4 const &projection, float width, float height);
    void drag(float x, float y, glm::mat4 const &projection, float width, float height);

    ViewedSurface _surface;
    SurfacePainter _painter;
    SurfaceSettings _settings;
    SurfaceSettings _refined; // those that the surface has
    DrawSettings _drawSettings;
    OrbitCamera _camera;
    std::string _error;
    float _creaseAngle = 60;
    bool _isAnimated = false;
    bool _isFrozen = false; // cells
    bool _isDragging = false;
    double _time = 0;
};

// If refinement fails, the cause is shown, and the settings return to the last good ones.
void Viewer::refine() {
    try {
        _surface.Refine(_settings);
        _refined = _settings;
        _error.clear();
    } catch (std::runtime_error const &error) {
        _error = error.what();
        _settings = _refined;
    }
}

// Has the cells follow the camera and the control mesh.
void Viewer::follow(int width, int height) {
    try {
        _surface.Follow(_camera.ForPicture(width, height), _settings.cells, _isFrozen);
    } catch (std::runtime_error const &error) {
        _error = error.what();
    }
}

// The settings of cells, and their counts.
void Viewer::showCells() {
    CellSettings &cells = _settings.cells;
    ImGui::SliderFloat("pixel error", &cells.pixelError, kMinPixelError, kMaxPixelError, "%.2f",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    ImGui::SliderInt("last level", &cells.maxLevel, 0, BfrExt::CellTree::kLastLevel, "%d",
                     ImGuiSliderFlags_AlwaysClamp);
    ImGui::Checkbox("cull", &cells.isCulling);
    ImGui::SameLine();
    ImGui::Checkbox("freeze", &_isFrozen);
    if (_surface.GetCells() && _surface.GetCells()->IsRefined()) {
        CellView::Statistics const &statistics = _surface.GetCells()->GetStatistics();
        std::vector<long> const &byLevel = statistics.counts.cellsByLevel;
        for (std::size_t level = 0; level < byLevel.size(); ++level) {
            if (byLevel[level] > 0) {
                ImGui::Text("%ld cells of level %d", byLevel[level], int(level));
            }
        }
        ImGui::Text("%ld outside, %ld facing away, left coarse", statistics.counts.outside,
                    statistics.counts.backFacing);
        ImGui::Text("%d types of base faces", statistics.numTypes);
    }
}

// How patches are tessellated.
void Viewer::showPatches() {
    PatchSettings &patches = _drawSettings.patches;
    ImGui::Checkbox("by pixels", &patches.isByPixels);
    if (patches.isByPixels) {
        ImGui::SliderFloat("pixels", &patches.edgePixels, 1, 100, "%.0f",
                           ImGuiSliderFlags_AlwaysClamp);
    } else {
        ImGui::SliderFloat("rate", &patches.rate, 1, 32, "%.0f", ImGuiSliderFlags_AlwaysClamp);
    }
}

void Viewer::showPanel() {
    ImGui::SetNextWindowPos({10, 10}, ImGuiCond_FirstUseEver);
    ImGui::Begin("hexview", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::PushItemWidth(150);
    bool isChanged = false;
    if (ImGui::Checkbox("adaptive", &_settings.isAdaptive)) {
        _settings.arePatches = false;
        isChanged = true;
    }
    ImGui::SameLine();
    if (ImGui::Checkbox("patches", &_settings.arePatches)) {
        _settings.isAdaptive = false;
        isChanged = true;
    }
    if (_settings.isAdaptive) {
        showCells();
    } else {
        isChanged |= ImGui::SliderInt("level", &_settings.level, 0, kMaxLevel, "%d",
                                      ImGuiSliderFlags_AlwaysClamp);
        if (_settings.arePatches) {
            showPatches();
        } else {
            isChanged |= ImGui::Checkbox("limit points", &_settings.isLimit);
            isChanged |= chooseEnum("evaluator", kEvaluators, &_settings.evaluator);
        }
    }
    ImGui::Separator();
    isChanged |= chooseEnum("scheme", kSchemes, &_settings.scheme.schemeType);
    isChanged |= chooseEnum("first step", kFirstSteps, &_settings.scheme.firstStep);
    isChanged |= chooseEnum("mask", kMasks, &_settings.scheme.faceMask);
    isChanged |= chooseEnum("boundary", kBoundaries, &_settings.boundary);
    bool hasCreases = _settings.creaseAngle.has_value();
    isChanged |= ImGui::Checkbox("creases from angle", &hasCreases);
    if (hasCreases) {
        isChanged |= ImGui::SliderFloat("degrees", &_creaseAngle, 0, 180, "%.0f");
    }
    _settings.creaseAngle = hasCreases ? std::optional<double>(_creaseAngle) : std::nullopt;
    if (isChanged) {
        refine();
    }
    ImGui::Separator();
    chooseEnum("shading", kShadings, &_drawSettings.shading);
    ImGui::Checkbox("faces", &_drawSettings.hasFaces);
    ImGui::SameLine();
    ImGui::Checkbox("edges", &_drawSettings.hasEdges);
    ImGui::SameLine();
    ImGui::Checkbox("control mesh", &_drawSettings.hasControlMesh);
    ImGui::Checkbox("animate", &_isAnimated);
    ImGui::SameLine();
    if (ImGui::Button("rest")) {
        _surface.GetControlPoints() = _surface.GetMesh().positions;
        _surface.Evaluate();
    }
    ImGui::Separator();
    ImGui::Text(_surface.GetPatches() ? "%d points, %d patches" : "%d vertices, %d faces",
                _surface.GetNumVertices(), _surface.GetNumFaces());
    ImGui::Text("%.2f ms for a frame's vertices", _surface.GetMilliseconds());
    if (!_error.empty()) {
        ImGui::TextColored({0.9f, 0.3f, 0.2f, 1}, "%s", _error.c_str());
    }
    ImGui::PopItemWidth();
    ImGui::End();
}

// Digits choose the level; e, c and a are for edges, control mesh and animation, v for cells that the
// view needs and f for freezing them, p for patches, and the tabulator goes through the shadings.
void Viewer::PressKey(int key) {
    switch (key) {
    case GLFW_KEY_E:
        _drawSettings.hasEdges = !_drawSettings.hasEdges;
        break;
    case GLFW_KEY_C:
        _drawSettings.hasControlMesh = !_drawSettings.hasControlMesh;
        break;
    case GLFW_KEY_A:
        _isAnimated = !_isAnimated;
        break;
    case GLFW_KEY_V:
        _settings.isAdaptive = !_settings.isAdaptive;
        _settings.arePatches = false;
        refine();
        break;
    case GLFW_KEY_P:
        _settings.arePatches = !_settings.arePatches;
        _settings.isAdaptive = false;
        refine();
        break;
    case GLFW_KEY_F:
        _isFrozen = !_isFrozen;
        break;
    case GLFW_KEY_TAB:
        _drawSettings.shading =
            Shading((int(_drawSettings.shading) + 1) % int(std::size(kShadings)));
        break;
    default:
        if (GLFW_KEY_0 <= key && key <= GLFW_KEY_0 + kMaxLevel) {
            _settings.level = key - GLFW_KEY_0;
            _settings.isAdaptive = false;
            refine();
        }
    }
}

// The place of a point in the picture, in pixels, and its depth.
glm::vec3 project(float const *point, glm::mat4 const &projection, float width, float height) {
    glm::vec4 const clip = projection * glm::vec4(point[0], point[1], point[2], 1);
    return {(clip.x / clip.w + 1) / 2 * width, (1 - clip.y / clip.w) / 2 * height, clip.w};
}

// The nearest of the control vertices that are drawn near a place; -1 if none is.
int Viewer::findControlVertex(float x, float y, glm::mat4 const &projection, float width,
                              float height) {
    std::vector<float> const &points = _surface.GetControlPoints();
    int best = -1;
    float bestDepth = std::numeric_limits<float>::max();
    for (std::size_t i = 0; i < points.size() / 3; ++i) {
        glm::vec3 const place = project(points.data() + 3 * i, projection, width, height);
        if (place.z > 0 && std::hypot(place.x - x, place.y - y) < kPickRadius &&
            place.z < bestDepth) {
            best = int(i);
            bestDepth = place.z;
        }
    }
    return best;
}

// Moves the chosen vertex in the plane of the picture.
void Viewer::drag(float x, float y, glm::mat4 const &projection, float width, float height) {
    float *const point =
        _surface.GetControlPoints().data() + 3 * std::size_t(_drawSettings.chosenVertex);
    glm::vec3 const place = project(point, projection, width, height);
    glm::vec4 const clip(2 * x / width - 1, 1 - 2 * y / height, 0, 1);
    glm::vec4 const old = projection * glm::vec4(point[0], point[1], point[2], 1);
    glm::vec4 const moved =
        glm::inverse(projection) * glm::vec4(clip.x * place.z, clip.y * place.z, old.z, place.z);
    for (int k = 0; k < 3; ++k) {
        point[k] = moved[k] / moved.w;
    }
    _surface.Evaluate();
}

void Viewer::readMouse(float width, float height) {
    ImGuiIO const &io = ImGui::GetIO();
    if (io.WantCaptureMouse) {
        return;
    }
    // Pixels of the framebuffer, of which a screen may have several for a unit of the mouse.
    float const x = io.MousePos.x * io.DisplayFramebufferScale.x;
    float const y = io.MousePos.y * io.DisplayFramebufferScale.y;
    glm::mat4 const projection = _camera.GetProjection(width / height);
    if (!io.MouseDown[0]) {
        _isDragging = false;
        _drawSettings.chosenVertex =
            _drawSettings.hasControlMesh ? findControlVertex(x, y, projection, width, height) : -1;
    } else if (io.MouseClicked[0]) {
        _isDragging = _drawSettings.chosenVertex >= 0;
    } else if (_isDragging) {
        if (io.MouseDelta.x != 0 || io.MouseDelta.y != 0) {
            drag(x, y, projection, width, height);
        }
    } else {
        constexpr float kDegreesPerUnit = 0.4f;
        constexpr float kSteepest = 89;
        _camera.azimuth -= kDegreesPerUnit * io.MouseDelta.x;
        _camera.elevation = std::clamp(_camera.elevation + kDegreesPerUnit * io.MouseDelta.y,
                                       -kSteepest, kSteepest);
    }
    if (io.MouseWheel != 0) {
        _camera.distance =
            std::clamp(_camera.distance * std::pow(0.9f, io.MouseWheel), 0.05f, 20.0f);
    }
}

// Twists the control mesh around the vertical axis, to and fro.
void Viewer::animate() {
    _time += double(ImGui::GetIO().DeltaTime);
    _surface.GetControlPoints() =
        TwistPoints(_surface.GetMesh().positions, _camera, float(std::sin(_time)));
    _surface.Evaluate();
}

} // namespace

void ShowWindow(Mesh const &mesh, std::string const &name, SurfaceSettings const &settings,
                DrawSettings const &drawSettings, OrbitCamera const &camera, int width,
                int height) {
    WindowHandle handle("hexview: " + name, width, height);
    Viewer viewer(mesh, settings, drawSettings, camera);
    while (!glfwWindowShouldClose(handle.window)) {
        glfwPollEvents();
        ImGui_ImplOpenGL3_NewFrame();
        ImGui_ImplGlfw_NewFrame();
        ImGui::NewFrame();
        int pixelWidth = 0;
        int pixelHeight = 0;
        glfwGetFramebufferSize(handle.window, &pixelWidth, &pixelHeight);
        for (int const key : handle.pressedKeys) {
            if (key == GLFW_KEY_ESCAPE) {
                glfwSetWindowShouldClose(handle.window, GLFW_TRUE);
            } else if (!ImGui::GetIO().WantTextInput) {
                viewer.PressKey(key);
            }
        }
        handle.pressedKeys.clear();
        viewer.Frame(std::max(pixelWidth, 1), std::max(pixelHeight, 1));
        ImGui::Render();
        ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
        glfwSwapBuffers(handle.window);
    }
}

} // namespace OpenSubdivHex::Tools
