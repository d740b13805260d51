// The Python module: one line per subject. Each subject's file binds one header of the core.
#include "bind.hpp"

NB_MODULE(ALULA_MODULE, m) {
  m.doc() = "Alula's compiled core: kinematics, filters, estimators and equations of motion.";
  bind_path(m);
  bind_linear_filter(m);
  bind_processor(m);
  bind_aero(m);
  bind_atmosphere(m);
  bind_airdata(m);
  bind_aircraft(m);
  bind_simulate(m);
  bind_recursive(m);
  bind_output_error(m);
  bind_asse(m);
  bind_navigate(m);
  bind_navigate_tools(m);
  bind_propellers(m);
  bind_strip(m);
#ifdef ALULA_HOST
  bind_vortex_lattice(m);
#endif
}
