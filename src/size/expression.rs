//! Gradation expressions: a spacing as the user writes it, `a*L1 + b*L2 + c*L3`.
//!
//! The crate `exmex` parses precedence and evaluates; its operators here are exactly rounded
//! arithmetic and functions of `libm`, so that a value has the same bits on every platform. Names,
//! parentheses and the order of operands are checked before, so that a complaint names a column.

mod scan;

use exmex::{BinOp, Express, FlatEx, MakeOperators, Operator};
use std::fmt;
use std::sync::Arc;

/// A variable of an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variable {
    /// First barycentric coordinate: of the lexicographically smallest corner.
    A,
    /// Second barycentric coordinate, counterclockwise.
    B,
    /// Third barycentric coordinate.
    C,
    /// Node spacing at the first corner; with direct grading the length of the nearest edge.
    L1,
    /// Node spacing at the second corner; with direct grading the length of the opposite edge.
    L2,
    /// Node spacing at the third corner.
    L3,
    /// Abscissa of the point.
    X,
    /// Ordinate of the point.
    Y,
    /// The growth field at the point.
    H,
    /// Direct grading: distance of the nearest edge.
    D1,
    /// Direct grading: distance of the opposite edge.
    D2,
    /// Surface models: the third coordinate of the point.
    Z,
    /// Surface models: the principal curvature of larger magnitude.
    K1,
    /// Surface models: the other principal curvature.
    K2,
    /// Surface models: area of the surface for an area of (u, v), sqrt(E G - F^2).
    J,
}

/// Number of variables.
pub(super) const VARIABLES: usize = 15;

impl Variable {
    /// Every variable.
    pub const ALL: [Self; VARIABLES] = [
        Self::A,
        Self::B,
        Self::C,
        Self::L1,
        Self::L2,
        Self::L3,
        Self::X,
        Self::Y,
        Self::H,
        Self::D1,
        Self::D2,
        Self::Z,
        Self::K1,
        Self::K2,
        Self::J,
    ];

    /// As it is written.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::A => "a",
            Self::B => "b",
            Self::C => "c",
            Self::L1 => "L1",
            Self::L2 => "L2",
            Self::L3 => "L3",
            Self::X => "x",
            Self::Y => "y",
            Self::H => "H",
            Self::D1 => "D1",
            Self::D2 => "D2",
            Self::Z => "z",
            Self::K1 => "k1",
            Self::K2 => "k2",
            Self::J => "J",
        }
    }
}

/// Values of the variables, in the order of [`Variable::ALL`].
pub(super) type Values = [f64; VARIABLES];

/// Why a text is no expression.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("column {column}: {problem}")]
pub struct ExpressionError {
    /// Where, in characters from 1.
    pub column: usize,
    /// What is wrong there.
    pub problem: String,
}

/// A parsed expression.
#[derive(Clone)]
pub struct Expression {
    text: String,
    /// Shared: it is some kilobytes, and options are copied about.
    program: Arc<FlatEx<f64, Functions>>,
    /// For each variable of the program its index in [`Values`].
    slots: Vec<usize>,
}

impl Expression {
    /// Parses an expression of numbers, `+ - * / ^`, parentheses, the variables of
    /// [`Variable::ALL`], `pi`, and the functions `abs sqrt exp log sin cos tan tanh atan floor`,
    /// `min` and `max` of two.
    ///
    /// # Errors
    /// The first fault and its column.
    ///
    /// ```
    /// use trigrade::mesher::{Gradation, Mesher};
    /// use trigrade::size::Expression;
    /// let finer_at_the_axis = Expression::parse("0.02 + 0.1*abs(y)")?;
    /// let mesher = Mesher::new().gradation(Gradation::Expression(finer_at_the_axis));
    /// assert_eq!(Expression::parse("0.02 + width").unwrap_err().column, 8);
    /// # Ok::<(), trigrade::size::ExpressionError>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, ExpressionError> {
        scan::check(text)?;
        let plain = scan::without_exponents(text)?;
        // The scanner has looked at every token: what is left is a disagreement between the two.
        let whole = |error: exmex::ExError| ExpressionError {
            column: 1,
            problem: format!("not understood: {}", error.msg()),
        };
        let program = FlatEx::<f64, Functions>::parse(&plain).map_err(whole)?;
        let slot = |name: &String| {
            Variable::ALL.iter().position(|v| v.name() == name).ok_or_else(|| ExpressionError {
                column: 1,
                problem: format!("`{name}` is no variable"),
            })
        };
        let slots = program.var_names().iter().map(slot).collect::<Result<_, _>>()?;
        Ok(Self { text: text.to_owned(), program: Arc::new(program), slots })
    }

    /// As it was written.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The column of the first use of a variable.
    #[must_use]
    pub fn column_of(&self, variable: Variable) -> Option<usize> {
        scan::column_of(&self.text, variable.name())
    }

    /// The value at a point of a surface, where `h` is the spacing of the model; NaN or infinite where
    /// the arithmetic gives that.
    #[must_use]
    pub fn on_surface(&self, [x, y, z]: [f64; 3], h: f64, [k1, k2]: [f64; 2], area: f64) -> f64 {
        let mut values = [f64::NAN; VARIABLES];
        let given = [
            (Variable::X, x),
            (Variable::Y, y),
            (Variable::Z, z),
            (Variable::H, h),
            (Variable::K1, k1),
            (Variable::K2, k2),
            (Variable::J, area),
        ];
        given.into_iter().for_each(|(variable, value)| values[variable as usize] = value);
        self.value(&values)
    }

    /// Whether every variable has a meaning on a surface.
    ///
    /// # Errors
    /// The column of the first that has none.
    pub fn demand_surface(&self) -> Result<(), ExpressionError> {
        use Variable::{H, J, K1, K2, X, Y, Z};
        let known = [X, Y, Z, H, K1, K2, J];
        let foreign = Variable::ALL.into_iter().filter(|variable| !known.contains(variable));
        let first = foreign.filter_map(|v| Some((self.column_of(v)?, v.name()))).min();
        first.map_or(Ok(()), |(column, name)| {
            let problem = format!(
                "`{name}` has a meaning in plane domains only; a surface has x, y, z, H, k1, k2 and J"
            );
            Err(ExpressionError { column, problem })
        })
    }

    /// The value; NaN or infinite where the arithmetic gives that.
    pub(super) fn value(&self, values: &Values) -> f64 {
        let mut used = [0.0; VARIABLES];
        for (value, &slot) in used.iter_mut().zip(&self.slots) {
            *value = values[slot];
        }
        // The number of values is right, so there is no error.
        self.program.eval(&used[..self.slots.len()]).unwrap_or(f64::NAN)
    }
}

impl fmt::Debug for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Expression({:?})", self.text)
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl std::str::FromStr for Expression {
    type Err = ExpressionError;

    fn from_str(text: &str) -> Result<Self, ExpressionError> {
        Self::parse(text)
    }
}

/// The operators: arithmetic, which IEEE 754 rounds exactly, and functions of `libm`.
#[derive(Clone, Debug)]
struct Functions;

impl MakeOperators<f64> for Functions {
    fn make<'a>() -> Vec<Operator<'a, f64>> {
        let binary = |apply, prio, is_commutative| BinOp { apply, prio, is_commutative };
        vec![
            Operator::make_bin("^", binary(libm::pow, 4, false)),
            Operator::make_bin("*", binary(|a, b| a * b, 2, true)),
            Operator::make_bin("/", binary(|a, b| a / b, 3, false)),
            Operator::make_bin_unary("+", binary(|a, b| a + b, 0, true), |a| a),
            Operator::make_bin_unary("-", binary(|a, b| a - b, 1, false), |a: f64| -a),
            // NaN must not vanish: f64::min and f64::max would drop it.
            Operator::make_bin(
                "min",
                binary(|a, b| if a < b || a.is_nan() { a } else { b }, 0, false),
            ),
            Operator::make_bin(
                "max",
                binary(|a, b| if a > b || a.is_nan() { a } else { b }, 0, false),
            ),
            Operator::make_unary("abs", f64::abs),
            Operator::make_unary("sqrt", libm::sqrt),
            Operator::make_unary("exp", libm::exp),
            Operator::make_unary("log", libm::log),
            Operator::make_unary("sin", libm::sin),
            Operator::make_unary("cos", libm::cos),
            Operator::make_unary("tan", libm::tan),
            Operator::make_unary("tanh", libm::tanh),
            Operator::make_unary("atan", libm::atan),
            Operator::make_unary("floor", libm::floor),
            Operator::make_constant("pi", std::f64::consts::PI),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VALUES: Values =
        [0.2, 0.3, 0.5, 1.0, 2.0, 4.0, -3.0, 7.0, 0.5, 8.0, 9.0, -5.0, 0.25, -0.125, 6.0];

    fn value(text: &str) -> f64 {
        Expression::parse(text).unwrap_or_else(|e| panic!("{text}: {e}")).value(&VALUES)
    }

    // spec: H7
    #[test]
    fn expressions_have_the_values_of_arithmetic() {
        for (text, wanted) in [
            ("a*L1 + b*L2 + c*L3", 2.8),
            ("(a*L1 + b*L2 + c*L3)/3", 2.8 / 3.0),
            ("(D1*L2 + D2*L1)/(D1 + D2)", 25.0 / 17.0),
            ("H", 0.5),
            ("1 + 2*3", 7.0),
            ("8/2/2", 2.0),
            ("8 - 4 - 2", 2.0),
            ("2*6/3", 4.0),
            ("6/3*2", 4.0),
            ("10 - 2 + 3", 11.0),
            ("2^10", 1024.0),
            ("2^-1", 0.5),
            ("-x", 3.0),
            ("z + k1*k2 + J", 0.968_75),
            ("-(x^2)", -9.0),
            ("min(H, 0.1 + abs(x))", 0.5),
            ("max(min(y, 5), 2)", 5.0),
            ("sqrt(16) + exp(0)", 5.0),
            ("1e-3 + 2.5E+1 + .5", 25.501),
            ("x*1e-300*1e300", -3.0),
            ("cos(pi)", -1.0),
        ] {
            assert!((value(text) - wanted).abs() < 1e-12, "{text}: {}", value(text));
        }
    }

    // spec: H7
    #[test]
    fn functions_are_those_of_libm_to_the_bit() {
        assert_eq!(value("sin(y)").to_bits(), libm::sin(7.0).to_bits());
        assert_eq!(value("exp(x)").to_bits(), libm::exp(-3.0).to_bits());
        assert_eq!(value("y^H").to_bits(), libm::pow(7.0, 0.5).to_bits());
        assert_eq!(value("log(y)*tan(y)").to_bits(), (libm::log(7.0) * libm::tan(7.0)).to_bits());
    }

    // spec: H7
    #[test]
    fn what_is_not_a_number_stays_so() {
        for text in
            ["min(1, log(x))", "min(log(x), 1)", "max(1, log(x))", "max(log(x), 1)", "0/(x+3)"]
        {
            assert!(value(text).is_nan(), "{text}: {}", value(text));
        }
        assert_eq!(value("1/(x+3)"), f64::INFINITY);
    }

    // spec: H7
    #[test]
    fn a_fault_names_its_column() {
        for (text, column, word) in [
            ("", 1, "empty"),
            ("   ", 1, "empty"),
            ("a*", 3, "ends"),
            ("a*L1 + q", 8, "`q`"),
            ("a L1", 3, "operator"),
            ("2 (3)", 3, "operator"),
            ("(a", 1, "never closed"),
            ("a)", 2, "never opened"),
            ("a + * b", 5, "operand"),
            ("sin x", 5, "`(`"),
            ("sin()", 5, "operand"),
            ("min(a)", 6, "two"),
            ("min(a, b, c)", 9, "two"),
            ("sin(a, b)", 6, "one"),
            ("(a, b)", 3, "comma"),
            ("a # b", 3, "`#`"),
            ("1.2.3", 1, "`1.2.3`"),
            ("1e", 1, "`1e`"),
            ("1e999", 1, "`1e999`"),
            ("-x^2", 3, "sign"),
            ("l1", 1, "`l1`"),
            ("ä", 1, "`ä`"),
        ] {
            let error = Expression::parse(text).expect_err(text);
            assert_eq!(error.column, column, "{text}: {error}");
            assert!(error.problem.contains(word), "{text}: {error}");
        }
    }

    #[test]
    fn deep_nesting_is_refused_and_does_not_overflow() {
        let deep = format!("{}1{}", "(".repeat(100_000), ")".repeat(100_000));
        assert!(Expression::parse(&deep).is_err());
        let long = vec!["x"; 20_000].join("+");
        assert!(Expression::parse(&long).is_err());
    }

    #[test]
    fn the_column_of_a_variable_is_that_of_the_whole_name() {
        let expression = Expression::parse("max(L1, x) + D1").unwrap();
        assert_eq!(expression.column_of(Variable::X), Some(9));
        assert_eq!(expression.column_of(Variable::D1), Some(14));
        assert_eq!(expression.column_of(Variable::A), None);
    }
}
