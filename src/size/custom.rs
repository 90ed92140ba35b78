//! A field by the user's own gradation function.

use super::direct::DirectField;
use super::expression::{Expression, ExpressionError, Values, Variable};
use super::growth::GrowthField;
use super::nodal::NodalField;
use crate::point::Point2;
use crate::size::Hint;
use std::sync::OnceLock;

/// What the variables of an expression are taken from.
#[derive(Debug)]
pub enum Inputs {
    /// a, b, c, L1, L2, L3: the background triangle at the point.
    Nodal(NodalField),
    /// D1, D2, L1, L2: the two edges of direct grading.
    Direct(DirectField),
}

impl Inputs {
    const fn has(&self, variable: Variable) -> bool {
        use Variable::{A, B, C, D1, D2, H, J, K1, K2, L1, L2, L3, X, Y, Z};
        match variable {
            X | Y | H | L1 | L2 => true,
            A | B | C | L3 => matches!(self, Self::Nodal(_)),
            D1 | D2 => matches!(self, Self::Direct(_)),
            Z | K1 | K2 | J => false,
        }
    }
}

/// A value that is no spacing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BadSpacing {
    /// Where, in the unit of the domain.
    pub at: Point2,
    /// The expression's value there.
    pub value: f64,
}

/// A field by an expression. Points and spacings of the mesher are the user's divided by `unit`;
/// the expression sees the user's.
#[derive(Debug)]
pub struct ExpressionField {
    expression: Expression,
    inputs: Inputs,
    growth: GrowthField,
    unit: f64,
    /// The first value that is no spacing. The field goes on with the growth field's, and whoever
    /// runs it asks when he can stop.
    fault: OnceLock<BadSpacing>,
}

impl ExpressionField {
    /// A field of `expression` over `inputs`, where H is `growth`.
    ///
    /// # Errors
    /// The column of a variable that these inputs do not have.
    pub fn new(
        expression: Expression,
        inputs: Inputs,
        growth: GrowthField,
        unit: f64,
    ) -> Result<Self, ExpressionError> {
        for variable in Variable::ALL.into_iter().filter(|&v| !inputs.has(v)) {
            if let Some(column) = expression.column_of(variable) {
                let method = if matches!(inputs, Inputs::Nodal(_)) { "graded" } else { "direct" };
                let name = variable.name();
                let problem = match variable {
                    Variable::Z | Variable::K1 | Variable::K2 | Variable::J => format!(
                        "`{name}` has a meaning on surface models only: a plane domain has no \
                         curvature, and its map no stretch"
                    ),
                    _ => format!("the method {method} has no variable `{name}`"),
                };
                return Err(ExpressionError { column, problem });
            }
        }
        Ok(Self { expression, inputs, growth, unit, fault: OnceLock::new() })
    }

    /// The spacing at `p`; where the expression's value is none, that of the growth field.
    pub fn at(&self, p: Point2, hint: &mut Hint) -> f64 {
        let value = self.expression.value(&self.values(p, hint));
        let spacing = value / self.unit;
        if value > 0.0 && spacing > 0.0 && spacing.is_finite() {
            return spacing;
        }
        let _ = self.fault.set(BadSpacing { at: self.grown(p), value });
        self.growth.at(p)
    }

    /// The first value that was no spacing.
    #[must_use]
    pub fn fault(&self) -> Option<BadSpacing> {
        self.fault.get().copied()
    }

    fn grown(&self, p: Point2) -> Point2 {
        Point2::new(p.x * self.unit, p.y * self.unit)
    }

    fn values(&self, p: Point2, hint: &mut Hint) -> Values {
        let at = self.grown(p);
        let h = self.growth.at(p) * self.unit;
        let (weights, lengths, distances) = match &self.inputs {
            Inputs::Nodal(field) => {
                let (weights, lengths) = field.corners_at(p, hint);
                (weights, lengths, [0.0; 2])
            }
            Inputs::Direct(field) => {
                let (nearest, opposite) = field.edges_at(p);
                let ((d1, l1), (d2, l2)) = (nearest, opposite.unwrap_or(nearest));
                ([0.0; 3], [l1, l2, 0.0], [d1, d2])
            }
        };
        let [a, b, c] = weights;
        let [l1, l2, l3] = lengths.map(|l| l * self.unit);
        let [d1, d2] = distances.map(|d| d * self.unit);
        // What only surfaces have was refused.
        [a, b, c, l1, l2, l3, at.x, at.y, h, d1, d2, 0.0, 0.0, 0.0, 0.0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::size::{NodalRule, Source};
    use crate::triangulation::{TriangleId, Triangulation, VertexId};

    fn inputs() -> Inputs {
        let mut background = Triangulation::default();
        background.add([2, 0, 1].map(VertexId));
        let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(Point2::from).to_vec();
        Inputs::Nodal(NodalField::new(background, points, vec![1.0, 2.0, 4.0], NodalRule::Mean))
    }

    fn field(text: &str, unit: f64) -> Result<ExpressionField, ExpressionError> {
        let source = Source { at: Point2::new(0.0, 0.0), spacing: 1.0 };
        let growth = GrowthField::new(&[source], 0.5);
        ExpressionField::new(Expression::parse(text)?, inputs(), growth, unit)
    }

    fn at(text: &str, unit: f64) -> f64 {
        let hint = &mut Hint(TriangleId(0));
        field(text, unit).expect("a good expression").at(Point2::new(0.25, 0.5), hint)
    }

    // spec: H7
    #[test]
    fn corners_count_from_the_lexicographically_smallest() {
        for (text, wanted) in [("a", 0.25), ("b", 0.25), ("c", 0.5), ("L1", 1.0), ("L2", 2.0)] {
            assert_eq!(at(text, 1.0), wanted, "{text}");
        }
        assert_eq!(at("a*L1 + b*L2 + c*L3", 1.0), 2.75);
    }

    // spec: H7
    #[test]
    fn an_expression_sees_the_user_s_unit() {
        for (text, wanted) in [("x", 0.25), ("y", 0.5), ("L3", 4.0), ("8", 1.0), ("8*a", 0.25)] {
            assert_eq!(at(text, 8.0), wanted, "{text}");
        }
        let h = 1.0 + 0.5 * Point2::new(0.25, 0.5).distance(Point2::new(0.0, 0.0));
        assert_eq!(at("H", 8.0), h);
    }

    // spec: !H7
    #[test]
    fn a_value_that_is_no_spacing_is_kept_with_its_point() {
        for (text, value) in [("x - 1", -0.5), ("0", 0.0), ("1/(x - x)", f64::INFINITY)] {
            let field = field(text, 2.0).expect("a good expression");
            assert_eq!(field.fault(), None);
            let h = field.at(Point2::new(0.25, 0.5), &mut Hint(TriangleId(0)));
            assert!(h > 0.0 && h.is_finite());
            assert_eq!(field.fault(), Some(BadSpacing { at: Point2::new(0.5, 1.0), value }));
        }
        let nan = field("log(0 - x)", 1.0).expect("a good expression");
        let _ = nan.at(Point2::new(0.25, 0.5), &mut Hint(TriangleId(0)));
        assert!(nan.fault().is_some_and(|fault| fault.value.is_nan()));
    }

    // spec: !H7
    #[test]
    fn variables_of_the_other_method_are_refused_by_column() {
        let error = field("H + D2", 1.0).expect_err("D2 is direct grading's");
        assert_eq!(error.column, 5);
        assert!(error.problem.contains("`D2`"), "{error}");
    }

    // spec: S24
    #[test]
    fn variables_of_surfaces_are_refused_in_the_plane_with_the_reason() {
        for (text, column) in [("k1", 1), ("0.1/abs(k2)", 9), ("x + J", 5), ("z", 1)] {
            let error = field(text, 1.0).expect_err(text);
            assert_eq!(error.column, column);
            assert!(error.problem.contains("a plane domain has no curvature"), "{error}");
        }
        for text in ["a*L1", "x + D2", "L3"] {
            let error = Expression::parse(text).expect("sound").demand_surface();
            assert!(error.expect_err(text).problem.contains("in plane domains only"));
        }
        let all = Expression::parse("x + y + z + H + k1 + k2 + J").expect("sound");
        assert_eq!(all.demand_surface(), Ok(()));
        assert_eq!(all.on_surface([1.0, 2.0, 4.0], 8.0, [16.0, 32.0], 64.0), 127.0);
    }
}
