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
    # It asks for a BLAS, which nothing of ours calls: a plain one where there is one, since OpenBLAS starts threads as soon
    # as it is loaded. What libcholmod loads is redirected by naming it before; a run path alone isn't enough.
    find_library(PLAIN_BLAS NAMES libblas.so.3 PATHS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/blas NO_DEFAULT_PATH)
    find_library(PLAIN_LAPACK NAMES liblapack.so.3 PATHS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/lapack NO_DEFAULT_PATH)
    if(PLAIN_BLAS AND PLAIN_LAPACK)
      get_filename_component(PLAIN_BLAS_DIR ${PLAIN_BLAS} DIRECTORY)
      get_filename_component(PLAIN_LAPACK_DIR ${PLAIN_LAPACK} DIRECTORY)
      target_link_libraries(impinge_engine PRIVATE -Wl,--no-as-needed ${PLAIN_BLAS} ${PLAIN_LAPACK} -Wl,--as-needed
                            -Wl,-rpath,${PLAIN_BLAS_DIR}:${PLAIN_LAPACK_DIR})
    endif()
    target_link_libraries(impinge_engine PRIVATE ${CHOLMOD_LIB})
  endif()
endif()
