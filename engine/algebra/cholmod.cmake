# CHOLMOD for engine/algebra/cholmod_llt.cpp, where it is installed (libsuitesparse-dev): the order of the unknowns and the
# supernodes. include() this after impinge_engine is defined. Its supernodal part is under GPL-2+: so is a program linked
# with it.
option(IMPINGE_WITH_CHOLMOD "use CHOLMOD's supernodal analysis where it is found (makes the program GPL)" ON)
if(IMPINGE_WITH_CHOLMOD)
  find_library(CHOLMOD_LIB cholmod)
  find_path(CHOLMOD_INC cholmod.h PATH_SUFFIXES suitesparse)
  if(CHOLMOD_LIB AND CHOLMOD_INC)
    message(STATUS "CHOLMOD: ${CHOLMOD_LIB}")
    target_compile_definitions(impinge_engine PRIVATE IMPINGE_CHOLMOD)
    target_include_directories(impinge_engine SYSTEM PRIVATE ${CHOLMOD_INC})
    target_link_libraries(impinge_engine PRIVATE ${CHOLMOD_LIB})
  endif()
endif()
