// SPDX-License-Identifier: Apache-2.0
//
// Executors and numbers of threads.
#include "options.h"

#include "far_ext/executor.h"
#ifdef _OPENMP
#endif
#ifdef OPENSUBDIVHEX_HAS_TBB
#include "far_ext/tbbExecutor.h"
#endif

#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

namespace OpenSubdivHex::Python {

namespace {

using namespace FarExt;

enum class ExecutorType { Default, Omp, Tbb };
constexpr ExecutorType kExecutorTypes[] = {ExecutorType::Default, ExecutorType::Omp,
                                           ExecutorType::Tbb};

/// Null where the module was built without it.  They live as long as the process, so that threads
/// which Python left behind may use them to its end.
Executor *findExecutor(ExecutorType type) {
    switch (type) {
    case ExecutorType::Default:
        return &GetDefaultExecutor();
    case ExecutorType::Omp: {
#ifdef _OPENMP
        static auto &executor = *new OmpExecutor;
        return &executor;
#else
        break;
#endif
    }
    case ExecutorType::Tbb: {
#ifdef OPENSUBDIVHEX_HAS_TBB
        static auto &executor = *new TbbExecutor;
        return &executor;
#else
        break;
#endif
    }
    }
    return nullptr;
}

Executor *takeExecutor(py::object const &object) {
    auto const type = TakeEnum<ExecutorType>(object, "executor");
    Executor *const executor = findExecutor(type);
    if (!executor) {
        throw py::value_error("executor: this module was built without " +
                              std::string(type == ExecutorType::Omp ? "OpenMP" : "TBB"));
    }
    return executor;
}

std::vector<ExecutorType> getExecutors() {
    std::vector<ExecutorType> types;
    for (ExecutorType type : kExecutorTypes) {
        if (findExecutor(type)) {
            types.push_back(type);
        }
    }
    return types;
}

/// Nothing where a host of the library has set one of its own.
std::optional<ExecutorType> getExecutor() {
    for (ExecutorType type : getExecutors()) {
        if (findExecutor(type) == &GetExecutor()) {
            return type;
        }
    }
    return std::nullopt;
}

void checkNumThreads(int numThreads) {
    if (numThreads < 0) {
        throw py::value_error("num_threads: " + std::to_string(numThreads) + " is negative");
    }
}

/// \brief An ExecutorScope as a context manager.
class Scope {
public:
    Scope(py::object const &executor, int numThreads)
        : _executor(executor.is_none() ? nullptr : takeExecutor(executor)),
          _numThreads(numThreads) {
        checkNumThreads(numThreads);
    }

    /// One that was entered and never ended, in a generator that was dropped say, ends here.  Where it
    /// cannot, the thread keeps its settings.
    ~Scope() {
        if (innermost == this) {
            Exit();
        } else {
            static_cast<void>(_scope.release());
        }
    }

    Scope(Scope const &) = delete;
    Scope &operator=(Scope const &) = delete;

    void Enter() {
        if (_scope) {
            throw std::runtime_error("the scope was entered already");
        }
        _scope = std::make_unique<ExecutorScope>(_executor, _numThreads);
        _outer = innermost;
        innermost = this;
    }

    /// Generators, unlike with statements, can end scopes out of order.
    void Exit() {
        if (innermost != this) {
            throw std::runtime_error("scopes end in the thread that entered them, the last first");
        }
        innermost = _outer;
        _scope.reset();
    }

private:
    static thread_local Scope *innermost;

    Executor *_executor;
    int _numThreads;
    std::unique_ptr<ExecutorScope> _scope;
    Scope *_outer = nullptr;
};

thread_local Scope *Scope::innermost = nullptr;

} // namespace

void BindThreads(py::module_ &module) {
    py::enum_<ExecutorType>(module, "ExecutorType", "The thread pool that the library uses.")
        .value("DEFAULT", ExecutorType::Default, "Those of the library, which all calls share.")
        .value("OMP", ExecutorType::Omp, "Those of OpenMP.")
        .value("TBB", ExecutorType::Tbb, "Those of TBB, with which Blender and Embree work.");
    py::class_<Scope>(
        module, "ExecutorScope",
        "ExecutorScope(executor=None, num_threads=0)\n\n"
        "A context manager for the calls inside it, from the thread that entered it.\n\n"
        "Args:\n"
        "    executor: an ExecutorType, or its name; None: the executor stays\n"
        "    num_threads: the largest number of threads; 0: the number stays, or, with an\n"
        "        executor, is the executor's own")
        .def(py::init<py::object const &, int>(), py::arg("executor") = py::none(),
             py::arg("num_threads") = 0)
        .def(
            "__enter__",
            [](py::object const &self) {
                self.cast<Scope &>().Enter();
                return self;
            },
            "__enter__()\n\nBegins the scope.")
        .def(
            "__exit__",
            [](Scope &self, py::object const &, py::object const &, py::object const &) {
                self.Exit();
            },
            "__exit__(type, value, traceback)\n\nEnds it.  Raises RuntimeError unless it is the "
            "innermost of the thread.",
            py::arg("type"), py::arg("value"), py::arg("traceback"));
    module.def("get_executors", &getExecutors,
               "get_executors()\n\n"
               "The list of ExecutorTypes that this module was built with.");
    module.def("get_executor", &getExecutor,
               "get_executor()\n\n"
               "The ExecutorType that calls from this thread use; None for a host program's own "
               "executor.");
    module.def(
        "set_executor", [](py::object const &executor) { SetExecutor(takeExecutor(executor)); },
        "set_executor(executor)\n\n"
        "Sets the executor of all threads' calls: an ExecutorType or its name.  Results do not "
        "depend on\n"
        "the executor.  Raises ValueError if the module was built without it.",
        py::arg("executor"));
    module.def(
        "set_num_threads",
        [](int numThreads) {
            checkNumThreads(numThreads);
            SetNumThreads(numThreads);
        },
        "set_num_threads(num_threads)\n\n"
        "Sets the largest number of threads for calls from the calling thread; 0: the executor's "
        "number.\n"
        "Results do not depend on it.  Raises ValueError if it is negative.",
        py::arg("num_threads"));
    module.def("get_num_threads", &GetNumThreads,
               "get_num_threads()\n\n"
               "The largest number of threads that a call from this thread uses.");
}

} // namespace OpenSubdivHex::Python
