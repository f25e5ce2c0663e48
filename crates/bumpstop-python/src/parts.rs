//! What a problem is made of.

use crate::core_error;
use crate::formula::Word;
use crate::user::{OutsideProgram, UserLaw};
use bumpstop_core::error::Result;
use bumpstop_core::forcing::{self, Beyond, Moved, Table};
use bumpstop_core::{law, obstacle, rotation, system};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

/// `q'' + (diag(damping) + coupling) q' + (diag(omega2) + circulatory) q = f`, unit modal mass.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct System(pub system::ModalSystem);

#[pymethods]
impl System {
    #[new]
    #[pyo3(signature = (omega2, damping, coupling=None, circulatory=None))]
    fn new(
        omega2: PyReadonlyArray1<f64>,
        damping: PyReadonlyArray1<f64>,
        coupling: Option<PyReadonlyArray2<f64>>,
        circulatory: Option<PyReadonlyArray2<f64>>,
    ) -> PyResult<Self> {
        let build = || {
            let mut system = system::ModalSystem::new(values(&omega2), values(&damping))?;
            if let Some(coupling) = coupling {
                system = system.with_coupling(rows(&coupling))?;
            }
            if let Some(circulatory) = circulatory {
                system = system.with_circulatory(rows(&circulatory))?;
            }
            Ok(Self(system))
        };
        build().map_err(core_error)
    }

    /// The same with one more shaft whose speed changes: its course, gyroscopic matrices for speed
    /// and acceleration, and forces of masses out of centre at the angles 0 and a quarter turn.
    #[pyo3(signature = (course, gyroscopic=None, unbalance=None))]
    #[allow(clippy::needless_pass_by_value)] // mirrors the Python signature
    fn with_rotation(
        &self,
        course: &Course,
        gyroscopic: Option<[PyReadonlyArray2<f64>; 2]>,
        unbalance: Option<[PyReadonlyArray1<f64>; 2]>,
    ) -> PyResult<Self> {
        let build = || {
            let mut turning = rotation::Rotation::new(course.0.clone(), self.0.modes());
            if let Some([speed, acceleration]) = &gyroscopic {
                turning = turning.with_gyroscopic(rows(speed), rows(acceleration))?;
            }
            if let Some(forces) = &unbalance {
                turning = turning.with_unbalance(forces.each_ref().map(values))?;
            }
            self.0.clone().with_rotation(turning).map(Self)
        };
        build().map_err(core_error)
    }
}

/// How a shaft turns.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct Course(pub rotation::Course);

#[pymethods]
impl Course {
    /// Stretches are (start, coefficients of the speed in powers of the time since then).
    #[new]
    #[allow(clippy::needless_pass_by_value)] // what pyo3 converts to
    fn new(angle: f64, speeds: Vec<(f64, Vec<f64>)>) -> PyResult<Self> {
        rotation::Course::new(angle, &speeds)
            .map(Self)
            .map_err(core_error)
    }

    /// Angle in rad, speed and acceleration at times, (3, time).
    #[allow(clippy::needless_pass_by_value)] // what pyo3 converts to
    fn at<'py>(
        &self,
        py: Python<'py>,
        times: PyReadonlyArray1<f64>,
    ) -> [Bound<'py, PyArray1<f64>>; 3] {
        let turns: Vec<_> = times.as_array().iter().map(|t| self.0.turn(*t)).collect();
        [0, 1, 2].map(|part| PyArray1::from_iter(py, turns.iter().map(|turn| turn[part])))
    }
}

/// Modal forces as functions of time: constant ones, and vectors times polynomials, harmonics and
/// tables.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct Forcing(pub forcing::Forcing);

type Column<'py> = PyReadonlyArray1<'py, f64>;

/// An obstacle: the number of its law, and which of its local coordinates.
type Obstacle = (usize, usize);

#[pymethods]
impl Forcing {
    /// Polynomials are (direction, coefficients), harmonics (omega, cosine, sine), tables
    /// (direction, times, values, whether the values at its ends hold beyond them).
    #[new]
    #[pyo3(signature = (constant, polynomials=Vec::new(), harmonics=Vec::new(), tables=Vec::new()))]
    #[allow(clippy::needless_pass_by_value)] // mirrors the Python signature
    fn new(
        constant: Column<'_>,
        polynomials: Vec<(Column<'_>, Column<'_>)>,
        harmonics: Vec<(f64, Column<'_>, Column<'_>)>,
        tables: Vec<(Column<'_>, Column<'_>, Column<'_>, bool)>,
    ) -> PyResult<Self> {
        let build = || {
            let mut forcing = forcing::Forcing::constant(values(&constant))?;
            for (direction, coefficients) in &polynomials {
                forcing = forcing.with_polynomial(values(direction), values(coefficients))?;
            }
            for (omega, cosine, sine) in &harmonics {
                forcing = forcing.with_harmonic(*omega, &values(cosine), &values(sine))?;
            }
            for (direction, times, knots, holds) in &tables {
                forcing = forcing.with_table(values(direction), table(times, knots, *holds)?)?;
            }
            Ok(forcing)
        };
        build().map(Self).map_err(core_error)
    }

    /// The same with obstacles that move, each by the number of its law and of the local coordinate
    /// that the motion is taken off: polynomials are (obstacle, coefficients), harmonics (obstacle,
    /// omega, cosine, sine), tables (obstacle, times, values, whether the values at its ends hold
    /// beyond them).
    fn with_motions(
        &self,
        polynomials: Vec<(Obstacle, Column<'_>)>,
        harmonics: Vec<(Obstacle, f64, f64, f64)>,
        tables: Vec<(Obstacle, Column<'_>, Column<'_>, bool)>,
    ) -> PyResult<Self> {
        let build = || {
            let mut forcing = self.0.clone();
            for (obstacle, coefficients) in &polynomials {
                forcing = forcing.with_polynomial_motion(moved(*obstacle), values(coefficients))?;
            }
            for (obstacle, omega, cosine, sine) in harmonics {
                forcing = forcing.with_harmonic_motion(moved(obstacle), omega, cosine, sine)?;
            }
            for (obstacle, times, knots, holds) in &tables {
                let table = table(times, knots, *holds)?;
                forcing = forcing.with_table_motion(moved(*obstacle), table)?;
            }
            Ok(forcing)
        };
        build().map(Self).map_err(core_error)
    }

    /// The modal forces at a time.
    fn at<'py>(&self, py: Python<'py>, time: f64) -> Bound<'py, PyArray1<f64>> {
        let mut forces = self.0.forces().to_vec();
        self.0.at(time, &mut forces);
        forces.into_pyarray(py)
    }
}

fn moved((law, coordinate): Obstacle) -> Moved {
    Moved { law, coordinate }
}

fn table(times: &Column<'_>, knots: &Column<'_>, holds: bool) -> Result<Table> {
    let beyond = if holds { Beyond::Hold } else { Beyond::Zero };
    Table::new(values(times), values(knots), beyond)
}

/// A unilateral spring and damper at distance `d = gap + row . q`.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct Stop(pub law::Stop);

#[pymethods]
impl Stop {
    #[new]
    fn new(row: PyReadonlyArray1<f64>, gap: f64, stiffness: f64, damping: f64) -> PyResult<Self> {
        law::Stop::new(values(&row), gap, stiffness, damping)
            .map(Self)
            .map_err(core_error)
    }
}

/// A stop that rubs along the coordinate `tangent . q`.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct FrictionStop(pub law::FrictionStop);

#[pymethods]
impl FrictionStop {
    #[new]
    #[pyo3(signature = (normal, tangent, static_coefficient, dynamic_coefficient, stiffness,
                        damping, by_velocity_sign=false))]
    #[allow(clippy::too_many_arguments)] // mirrors the Python signature
    fn new(
        normal: PyRef<'_, Stop>,
        tangent: PyReadonlyArray1<f64>,
        static_coefficient: f64,
        dynamic_coefficient: f64,
        stiffness: f64,
        damping: f64,
        by_velocity_sign: bool,
    ) -> PyResult<Self> {
        let friction = law::Friction {
            static_coefficient,
            dynamic_coefficient,
            stiffness,
            damping,
            rule: if by_velocity_sign {
                law::SlidingRule::VelocitySign
            } else {
                law::SlidingRule::Slider
            },
        };
        law::FrictionStop::new(normal.0.clone(), values(&tangent), friction)
            .map(Self)
            .map_err(core_error)
    }
}

/// A multilinear elastic spring of deformation `row . q`.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct Spring(pub law::Spring);

#[pymethods]
impl Spring {
    #[new]
    fn new(
        row: PyReadonlyArray1<f64>,
        breaks: PyReadonlyArray1<f64>,
        stiffness: PyReadonlyArray1<f64>,
        preload: f64,
        damping: f64,
    ) -> PyResult<Self> {
        let (breaks, stiffness) = (values(&breaks), values(&stiffness));
        law::Spring::new(values(&row), breaks, &stiffness, preload, damping)
            .map(Self)
            .map_err(core_error)
    }
}

/// A multilinear damper of elongation `row . q`.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct Damper(pub law::Damper);

#[pymethods]
impl Damper {
    #[new]
    fn new(
        row: PyReadonlyArray1<f64>,
        breaks: PyReadonlyArray1<f64>,
        damping: PyReadonlyArray1<f64>,
        offset: f64,
    ) -> PyResult<Self> {
        let (breaks, damping) = (values(&breaks), values(&damping));
        law::Damper::new(values(&row), breaks, &damping, offset)
            .map(Self)
            .map_err(core_error)
    }
}

/// A force along the coordinate `row . q` that is a formula of its position and velocity.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct ForceRelation(pub law::ForceRelation);

#[pymethods]
impl ForceRelation {
    /// The program is a list of numbers and of names, as the machine takes them one by one.
    #[new]
    #[allow(clippy::needless_pass_by_value)] // what pyo3 converts to
    fn new(row: PyReadonlyArray1<f64>, program: Vec<Word>) -> PyResult<Self> {
        let operations: PyResult<_> = program.iter().map(Word::operation).collect();
        law::Formula::new(operations?)
            .and_then(|formula| law::ForceRelation::new(values(&row), formula))
            .map(Self)
            .map_err(core_error)
    }

    /// The force for positions and velocities.
    fn force<'py>(
        &self,
        py: Python<'py>,
        position: PyReadonlyArray1<f64>,
        velocity: PyReadonlyArray1<f64>,
    ) -> Bound<'py, PyArray1<f64>> {
        let both = values(&position).into_iter().zip(values(&velocity));
        let forces: Vec<f64> = both.map(|(x, v)| self.0.force_at(x, v)).collect();
        forces.into_pyarray(py)
    }
}

/// A rigid obstacle at distance `d = gap + row . q`.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct RigidStop(pub law::RigidStop);

#[pymethods]
impl RigidStop {
    #[new]
    #[pyo3(signature = (row, gap, restitution, resolution=None, tangent=None, friction=0.0))]
    fn new(
        row: PyReadonlyArray1<f64>,
        gap: f64,
        restitution: f64,
        resolution: Option<f64>,
        tangent: Option<PyReadonlyArray1<f64>>,
        friction: f64,
    ) -> PyResult<Self> {
        law::RigidStop::new(values(&row), gap, restitution)
            .and_then(|stop| match resolution {
                Some(resolution) => stop.with_resolution(resolution),
                None => Ok(stop),
            })
            .and_then(|stop| match tangent {
                Some(tangent) => stop.with_friction(values(&tangent), friction),
                None => Ok(stop),
            })
            .map(Self)
            .map_err(core_error)
    }
}

/// An obstacle at distance `d = gap + row . q` whose force is a power of the depth.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct HertzStop(pub law::HertzStop);

#[pymethods]
impl HertzStop {
    #[new]
    fn new(
        row: PyReadonlyArray1<f64>,
        gap: f64,
        stiffness: f64,
        exponent: f64,
        hunt_crossley: f64,
    ) -> PyResult<Self> {
        law::HertzStop::new(values(&row), gap, stiffness, exponent, hunt_crossley)
            .map(Self)
            .map_err(core_error)
    }
}

/// Springs around a dashpot whose force is a power of its speed, of elongation `row . q`.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct ZenerDamper(pub law::ZenerDamper);

#[pymethods]
impl ZenerDamper {
    #[new]
    fn new(
        row: PyReadonlyArray1<f64>,
        in_series: f64,
        in_parallel: f64,
        in_branch: f64,
        damping: f64,
        exponent: f64,
    ) -> PyResult<Self> {
        let parts = law::Zener {
            in_series,
            in_parallel,
            in_branch,
            damping,
            exponent,
        };
        law::ZenerDamper::new(values(&row), parts)
            .map(Self)
            .map_err(core_error)
    }
}

/// Breaks and cubics of a function of the direction.
type Cubics = (Vec<f64>, Vec<[f64; 4]>);

/// A crack across a shaft that turns.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct CrackedRotor(pub law::CrackedRotor);

#[pymethods]
impl CrackedRotor {
    #[new]
    #[allow(clippy::needless_pass_by_value)] // what pyo3 converts to
    fn new(
        rows: [PyReadonlyArray1<f64>; 2],
        stiffness: Cubics,
        derivative: Cubics,
        course: &Course,
    ) -> PyResult<Self> {
        let build = || {
            let [stiffness, derivative] =
                [stiffness, derivative].map(|(breaks, cubics)| law::Periodic::new(breaks, cubics));
            let rows = rows.each_ref().map(values);
            law::CrackedRotor::new(rows, stiffness?, derivative?, course.0.clone()).map(Self)
        };
        build().map_err(core_error)
    }
}

/// The shape of an obstacle about the origin of a plane.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct Shape(pub obstacle::Shape);

#[pymethods]
impl Shape {
    /// Across the first coordinate, at a distance.
    #[staticmethod]
    fn plane(gap: f64) -> Self {
        Self(obstacle::Shape::Plane(obstacle::Plane { gap }))
    }

    /// With the structure inside or outside.
    #[staticmethod]
    fn circle(radius: f64, inside: bool) -> PyResult<Self> {
        let circle = if inside {
            obstacle::Circle::around(radius)
        } else {
            obstacle::Circle::beside(radius)
        };
        circle
            .map(|circle| Self(obstacle::Shape::Circle(circle)))
            .map_err(core_error)
    }

    /// Of corners in the order of their angles.
    #[staticmethod]
    #[allow(clippy::needless_pass_by_value)] // what pyo3 converts to
    fn polygon(corners: Vec<[f64; 2]>) -> PyResult<Self> {
        obstacle::Polygon::new(&corners)
            .map(|polygon| Self(obstacle::Shape::Polygon(polygon)))
            .map_err(core_error)
    }
}

/// A stop on an obstacle of a shape, at the place `origin + rows . q` of its plane.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct ShapedStop(pub law::ShapedStop);

#[pymethods]
impl ShapedStop {
    /// Friction is (static coefficient, dynamic coefficient, stiffness, damping).
    #[new]
    #[pyo3(signature = (rows, origin, shape, stiffness, damping, friction=None))]
    #[allow(clippy::needless_pass_by_value)] // what pyo3 converts to
    fn new(
        rows: Vec<Column<'_>>,
        origin: [f64; 2],
        shape: PyRef<'_, Shape>,
        stiffness: f64,
        damping: f64,
        friction: Option<[f64; 4]>,
    ) -> PyResult<Self> {
        let friction = friction.map(|[static_, dynamic, stiffness, damping]| law::Friction {
            static_coefficient: static_,
            dynamic_coefficient: dynamic,
            stiffness,
            damping,
            rule: law::SlidingRule::Slider,
        });
        let rows = rows.iter().map(values).collect();
        law::ShapedStop::new(rows, origin, shape.0.clone(), stiffness, damping, friction)
            .map(Self)
            .map_err(core_error)
    }
}

/// A spring whose stiffness falls beyond a threshold, with a damper, of elongation `row . q`.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct SeismicDevice(pub law::SeismicDevice);

#[pymethods]
impl SeismicDevice {
    #[new]
    #[allow(clippy::too_many_arguments)] // mirrors the Python signature
    fn new(
        row: PyReadonlyArray1<f64>,
        first_stiffness: f64,
        second_stiffness: f64,
        threshold: f64,
        damping: f64,
        exponent: f64,
        stroke: f64,
        rest_speed: f64,
    ) -> PyResult<Self> {
        let device = law::Device {
            first_stiffness,
            second_stiffness,
            threshold,
            damping,
            exponent,
            stroke,
            rest_speed,
        };
        law::SeismicDevice::new(values(&row), device)
            .map(Self)
            .map_err(core_error)
    }
}

/// An elastic-plastic spring of elongation `row . q`.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct HardeningSpring(pub law::HardeningSpring);

#[pymethods]
impl HardeningSpring {
    /// The points are elongations and tensions, the elastic limit first.
    #[new]
    #[allow(clippy::needless_pass_by_value)] // what pyo3 converts to
    fn new(row: PyReadonlyArray1<f64>, points: Vec<[f64; 2]>, kinematic: bool) -> PyResult<Self> {
        let hardening = if kinematic {
            law::Hardening::Kinematic
        } else {
            law::Hardening::Isotropic
        };
        law::HardeningSpring::new(values(&row), &points, hardening)
            .map(Self)
            .map_err(core_error)
    }
}

/// A stop that buckles.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct BucklingStop(pub law::BucklingStop);

#[pymethods]
impl BucklingStop {
    /// The unloading stiffness is a table of residual crushings and stiffnesses.
    #[new]
    #[allow(clippy::too_many_arguments)] // mirrors the Python signature
    #[allow(clippy::needless_pass_by_value)] // what pyo3 converts to
    fn new(
        elastic: PyRef<'_, Stop>,
        critical_force: f64,
        post_force: f64,
        plateau: f64,
        fall: f64,
        post_damping: f64,
        unloading: Vec<[f64; 2]>,
    ) -> PyResult<Self> {
        let buckling = law::Buckling {
            critical_force,
            post_force,
            plateau,
            fall,
            post_damping,
            unloading,
        };
        law::BucklingStop::new(elastic.0.clone(), buckling)
            .map(Self)
            .map_err(core_error)
    }
}

/// A law of any kind, as Python hands it over.
#[derive(FromPyObject)]
pub enum LawPart<'py> {
    Stop(PyRef<'py, Stop>),
    FrictionStop(PyRef<'py, FrictionStop>),
    Spring(PyRef<'py, Spring>),
    Damper(PyRef<'py, Damper>),
    ForceRelation(PyRef<'py, ForceRelation>),
    RigidStop(PyRef<'py, RigidStop>),
    HertzStop(PyRef<'py, HertzStop>),
    ZenerDamper(PyRef<'py, ZenerDamper>),
    CrackedRotor(PyRef<'py, CrackedRotor>),
    ShapedStop(PyRef<'py, ShapedStop>),
    SeismicDevice(PyRef<'py, SeismicDevice>),
    HardeningSpring(PyRef<'py, HardeningSpring>),
    BucklingStop(PyRef<'py, BucklingStop>),
    UserLaw(PyRef<'py, UserLaw>),
    OutsideProgram(PyRef<'py, OutsideProgram>),
}

impl LawPart<'_> {
    /// The core's law.
    pub fn law(&self) -> law::AnyLaw {
        match self {
            Self::Stop(law) => law.0.clone().into(),
            Self::FrictionStop(law) => law.0.clone().into(),
            Self::Spring(law) => law.0.clone().into(),
            Self::Damper(law) => law.0.clone().into(),
            Self::ForceRelation(law) => law.0.clone().into(),
            Self::RigidStop(law) => law.0.clone().into(),
            Self::HertzStop(law) => law.0.clone().into(),
            Self::ZenerDamper(law) => law.0.clone().into(),
            Self::CrackedRotor(law) => law.0.clone().into(),
            Self::ShapedStop(law) => law.0.clone().into(),
            Self::SeismicDevice(law) => law.0.clone().into(),
            Self::HardeningSpring(law) => law.0.clone().into(),
            Self::BucklingStop(law) => law.0.clone().into(),
            Self::UserLaw(law) => law.law.clone().into(),
            Self::OutsideProgram(law) => law.law.clone().into(),
        }
    }

    /// What Python code that answers for it went wrong with.
    pub fn raised(&self) -> Option<PyErr> {
        match self {
            Self::UserLaw(law) => law.raised(),
            Self::OutsideProgram(law) => law.raised(),
            _ => None,
        }
    }
}

/// The numbers of an array of any layout.
pub(crate) fn values(array: &PyReadonlyArray1<f64>) -> Vec<f64> {
    array.as_array().iter().copied().collect()
}

/// The rows of a matrix of any layout.
fn rows(array: &PyReadonlyArray2<f64>) -> Vec<Vec<f64>> {
    let rows = array.as_array();
    rows.outer_iter().map(|row| row.to_vec()).collect()
}
