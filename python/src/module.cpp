// SPDX-License-Identifier: MIT
// The extension module crossnav._core. Users import `crossnav`, which re-exports its names.
#include "common.h"

#include "crossnav/core/version.h"

namespace crossnav::python {
namespace {

/// Failure -> crossnav.Error with the program's text.
void Translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Failure& failure) {
    const Error& error = failure.error;
    const nb::object type = nb::module_::import_("crossnav._errors").attr("Error");
    const nb::object raised = type(error.what, error.where, NameOf(error.code));
    PyErr_SetObject(type.ptr(), raised.ptr());
  }
}

}  // namespace
}  // namespace crossnav::python

NB_MODULE(_core, m) {
  using namespace crossnav::python;  // NOLINT: the macro's scope is ours
  m.doc() = "crossnav's C++ library; import crossnav instead";
  m.attr("VERSION") = CROSSNAV_VERSION;
  nb::set_leak_warnings(false);  // objects alive at exit are no error
  nb::register_exception_translator(Translate);
  BindCore(m);
  BindGeometry(m);
  BindMemory(m);
  BindPerception(m);
  BindSimulator(m);
  BindStore(m);
  BindLanguage(m);
  BindRecordings(m);
  BindHooks(m);
  BindAgent(m);
  BindBench(m);
}
