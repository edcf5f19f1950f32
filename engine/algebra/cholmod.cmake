# CHOLMOD for engine/algebra/cholmod_llt.cpp, where it is installed (libsuitesparse-dev, with libopenblas0-serial for speed).
# include() this after impinge_engine is defined. Its supernodal part is under GPL-2+: so is a program linked with it.
option(IMPINGE_WITH_CHOLMOD "use CHOLMOD's supernodal factorization where it is found (makes the program GPL)" ON)
if(IMPINGE_WITH_CHOLMOD)
  find_library(CHOLMOD_LIB cholmod)
  find_path(CHOLMOD_INC cholmod.h PATH_SUFFIXES suitesparse)
  find_library(BLAS_LIB blas)  # supernodal_gram.cpp calls it too
  if(CHOLMOD_LIB AND CHOLMOD_INC AND BLAS_LIB)
    message(STATUS "CHOLMOD: ${CHOLMOD_LIB}")
    target_compile_definitions(impinge_engine PRIVATE IMPINGE_CHOLMOD)
    target_include_directories(impinge_engine SYSTEM PRIVATE ${CHOLMOD_INC})
    # pinned to the serial OpenBLAS: the threaded one gives other bits for other numbers of threads, and is slower here. The
    # libraries must be named before CHOLMOD; a run path alone doesn't redirect what libcholmod loads.
    find_library(SERIAL_BLAS NAMES libblas.so.3 PATHS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/openblas-serial NO_DEFAULT_PATH)
    find_library(SERIAL_LAPACK NAMES liblapack.so.3 PATHS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/openblas-serial NO_DEFAULT_PATH)
    if(SERIAL_BLAS AND SERIAL_LAPACK)
      get_filename_component(SERIAL_BLAS_DIR ${SERIAL_BLAS} DIRECTORY)
      target_link_libraries(impinge_engine PRIVATE -Wl,--no-as-needed ${SERIAL_BLAS} ${SERIAL_LAPACK} -Wl,--as-needed ${CHOLMOD_LIB} -Wl,-rpath,${SERIAL_BLAS_DIR})
    else()
      message(STATUS "no serial OpenBLAS (libopenblas0-serial): CHOLMOD will be several times slower")
      target_link_libraries(impinge_engine PRIVATE ${CHOLMOD_LIB} ${BLAS_LIB})
    endif()
  endif()
endif()
